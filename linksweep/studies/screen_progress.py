"""The file of an unfinished screening: its manifest, the number of designs that are done, and their tally.

It is written whole or not at all, its bytes behind their SHA-256.
"""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from linksweep.base.validate import refuse
from linksweep.files.atomic import whole
from linksweep.files.packed import packed, unpacked
from linksweep.studies.partial import differing
from linksweep.studies.tally import Tally

DIGEST = hashlib.sha256().digest_size


@dataclass(frozen=True)
class Progress:
    """The file at `path` of the screening that `manifest` states."""

    path: Path
    manifest: dict[str, Any]

    def load(self) -> tuple[int, Tally] | None:
        """Return the number of designs done and their tally; None where there is no file.

        Raises ValueError for a damaged file, and for that of another screening.
        """
        if not self.path.exists():
            return None
        content = self.path.read_bytes()
        digest, data = content[:DIGEST], content[DIGEST:]
        sound = hashlib.sha256(data).digest() == digest
        refuse([] if sound else [f"{self.path}: is damaged, or no file of a screening; delete it and screen again"])
        ds = unpacked(data)
        refuse(other_screening(self.path, json.loads(ds.attrs["manifest"]), self.manifest))
        return int(ds.attrs["done"]), Tally.of(ds)

    def keep(self, done: int, tally: Tally) -> None:
        """Write the file."""
        data = packed(tally.dataset.assign_attrs(done=done, manifest=json.dumps(self.manifest)))
        with whole(self.path) as temporary:
            temporary.write_bytes(hashlib.sha256(data).digest() + data)

    def remove(self) -> None:
        self.path.unlink(missing_ok=True)


def other_screening(path: Path, old: dict[str, Any], new: dict[str, Any]) -> list[str]:
    """Return the problem of a file that belongs to another screening."""
    different = [word for word in new if old.get(word) != new[word]]
    return [
        f"{path}: is of a screening with another {word}{differing(old.get(word), new[word])}; go on with that, move "
        f"the file away, or choose another name"
        for word in different[:1]
    ]
