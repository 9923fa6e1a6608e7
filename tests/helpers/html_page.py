"""A report page, read back by the standard library's parser."""

from html.parser import HTMLParser

VOID = {"meta", "img"}


class Page(HTMLParser):
    """A page read back: its sections' rows of cells, its numbers, images, warnings, and what it refers to."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.sections: dict[str, list[list[tuple[str, list[float]]]]] = {}
        self.numbers: list[tuple[str, float]] = []
        self.images: dict[str, str] = {}
        self.texts: dict[str, str] = {}
        self.references: list[str] = []
        self.tags: set[str] = set()
        self.warning = ""
        self.in_warning = False
        self.feed(text)
        self.close()
        assert not self.open

    def handle_starttag(self, name, attributes):
        parameters = dict(attributes)
        self.tags.add(name)
        self.references += [value for key, value in attributes if key in ("src", "href", "srcset", "action", "data")]
        if name in VOID:
            if name == "img":
                self.images[parameters["alt"]] = parameters["src"]
            return
        self.open.append(name)
        self.in_warning |= parameters.get("class") == "warning"
        if name == "h2":
            self.title = ""
        elif name == "tr":
            self.sections.setdefault(self.title, []).append([])
        elif name in ("td", "th"):
            self.sections[self.title][-1].append(("", []))
        elif name == "data":
            self.numbers.append(("", float(parameters["value"])))
            self.sections.get(self.title, [[("", [])]])[-1][-1][1].append(
                float(parameters["value"])
            ) if "td" in self.open else None

    def handle_endtag(self, name):
        assert self.open.pop() == name
        self.in_warning &= name != "section"

    def handle_data(self, data):
        inside = self.open[-1] if self.open else ""
        self.texts[inside] = self.texts.get(inside, "") + data
        if self.in_warning:
            self.warning += data
        if inside == "h2":
            self.title += data
        if inside == "data":
            text, value = self.numbers[-1]
            self.numbers[-1] = (text + data, value)
        if "tr" in self.open and self.sections[self.title][-1]:
            text, values = self.sections[self.title][-1][-1]
            self.sections[self.title][-1][-1] = (text + data, values)

    def rows(self, section: str) -> dict[str, list[tuple[str, list[float]]]]:
        """Rows of a section by the text of their first cell."""
        return {row[0][0]: row[1:] for row in self.sections[section]}
