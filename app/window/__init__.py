"""The window, made of Qt; it computes nothing: it reads the document and its results, and calls actions."""
