"""Exceptions: each says what is wrong, where, and what to do."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Dict, List, Optional


@dataclass(frozen=True)
class Finding:
    """An error or a warning about a scene or a program, with its place."""

    code: str
    """Stable code, such as "NB0201"; docs/errors.md lists them."""
    severity: str
    """"error" or "warning"."""
    message: str
    file: str
    line: Optional[int]
    """From 1; None if no text is to blame."""
    column: Optional[int]
    label: str
    """What is said under the marked text."""
    rule: Optional[str]
    """Id of the rule that is violated."""
    notes: List[str] = field(default_factory=list)
    help: Optional[str] = None
    """What to do."""


class NinebitError(Exception):
    """An error of this package."""

    def __init__(self, message: str, code: Optional[str] = None, help: Optional[str] = None) -> None:
        text = f"{code}: {message}" if code else message
        super().__init__(f"{text}\n  help: {help}" if help else text)
        self.message = message
        self.code = code
        """Stable code; None for an argument that is wrong."""
        self.help = help
        """What to do."""


class SceneError(NinebitError):
    """A scene or a program was refused. Its text shows every finding with its place."""

    def __init__(self, text: str, findings: List[Dict[str, Any]], status: int) -> None:
        self.findings = [Finding(**fields) for fields in findings]
        first = self.findings[0]
        super().__init__(first.message, first.code, first.help)
        self.text = text
        self.status = status
        """The exit status of the program: 3 invalid, 4 missing, 5 a limit."""

    def __str__(self) -> str:
        return self.text

    @property
    def place(self) -> str:
        """File, line and column of the first finding."""
        first = self.findings[0]
        return first.file if first.line is None else f"{first.file}:{first.line}:{first.column}"
