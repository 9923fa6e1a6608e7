"""Reading a text file, with what went wrong in words."""

from __future__ import annotations

from pathlib import Path

from linksweep.mechanisms.validate import did_you_mean


def text_of(path: Path, name: str, ending: str, where: str = "", advice: str = "") -> str:
    """The text of a file that messages call `name`. Raises ValueError where it cannot be read.

    Of one that is not there is said `where`, which file of that `ending` may be meant, and the `advice`.
    """
    try:
        return path.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        near = did_you_mean(path.name, [file.name for file in path.parent.glob(f"*{ending}")])
        raise ValueError(f"{name}: there is no such file{where}{near}{advice}") from None
    except OSError as error:
        raise ValueError(f"{name}: cannot be read: {error.strerror}") from None
    except UnicodeDecodeError:
        raise ValueError(f"{name}: is not a text file in UTF-8; save it as one") from None
