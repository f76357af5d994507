"""What elements between two bodies share: between which they act, and what they are called by."""

from __future__ import annotations

from equipoise.i18n import Note


class BetweenPoints:
    """Between `point` of `link` and the point `to` of `on`."""

    link: str
    point: str
    to: str
    on: str

    @property
    def bodies(self) -> tuple[str, str]:
        """The link and the body of the other point."""
        return self.link, self.on

    @property
    def points(self) -> tuple[tuple[str, str], ...]:
        """Both bodies, each with its point."""
        return (self.link, self.point), (self.on, self.to)

    @property
    def label(self) -> Note:
        """Both points, which distinguish it from others of its kind."""
        return Note("{point} to {other}", point=self.point, other=self.to)

    @property
    def route(self) -> tuple[str, str]:
        """Both points."""
        return self.point, self.to


class BetweenBodies:
    """Between `link` and `on`, whatever their places."""

    link: str
    on: str

    @property
    def bodies(self) -> tuple[str, str]:
        """The link and the other body."""
        return self.link, self.on

    @property
    def label(self) -> Note:
        """Both bodies, which distinguish it from others of its kind."""
        return Note("{link} on {on}", link=self.link, on=self.on)

    @property
    def route(self) -> tuple[str, str]:
        """From the other body to the link."""
        return self.on, self.link
