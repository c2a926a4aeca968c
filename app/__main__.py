"""``python -m app`` is the command line."""

from app.enter import main

if __name__ == "__main__":
    main()
