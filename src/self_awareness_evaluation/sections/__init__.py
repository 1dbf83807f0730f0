"""What pages say of rows: a section for each measurement."""
