"""Access to the HTTP server: names that it answers to, logins, and the guard before all routes."""
