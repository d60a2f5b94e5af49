"""What `check` knows of the nodes of trees as XML."""
