"""The program around the engines."""
