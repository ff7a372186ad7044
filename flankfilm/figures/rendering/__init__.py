"""Pictures of the loaded teeth: animation, window and files, drawn in a separate process."""
