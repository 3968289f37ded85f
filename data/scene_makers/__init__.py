"""Makers of the glTF scenes under data/: a file writer and reader, shapes, and one module per family of scenes."""
