"""What the robots are made of: links, limits, speeds and motor steps, in `robots/*.yaml`."""
