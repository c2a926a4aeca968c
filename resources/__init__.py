"""The built-in sample world and the program that makes it, icons, theme."""
