"""A plant's memory in a PostgreSQL database, which several hosts reach; needs the library psycopg."""
