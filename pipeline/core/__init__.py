"""Types, units, errors, configuration: what every floor above stands on."""
