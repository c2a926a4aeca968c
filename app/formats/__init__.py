"""Files from and for the outside: video, images, masks, meshes, sequences, cameras, tracks."""
