"""Flow fields that users bring: read, differentiated, judged point by point, and written back."""
