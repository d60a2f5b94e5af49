"""Teaching: targets and verbs that a person shows with the devices."""
