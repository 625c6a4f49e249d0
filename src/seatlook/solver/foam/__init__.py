"""What lies below the cover: distance, contact, settlement, friction."""
