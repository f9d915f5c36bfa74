"""One file per instrument export: bytes in, a Recording in SI out."""
