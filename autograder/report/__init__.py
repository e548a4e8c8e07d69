"""What people read of a result: feedback pages, and exports for other programs."""
