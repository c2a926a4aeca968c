"""The program that makes the sample world: bodies, gaits, scene, camera, picture, truth."""
