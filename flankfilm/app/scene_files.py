"""Files of the page: scenes and gear data below one folder, examples, and the template; nothing outside is touched."""

from __future__ import annotations

import hashlib
import os
from dataclasses import dataclass
from pathlib import Path

from base import InputError
from base.files import replacing
from flankfilm.app.checking import Place
from flankfilm.app.document import Document
from flankfilm.building.pair import gear_pair
from flankfilm.exchange.bring_in import imported
from flankfilm.exchange.rexs_write import rexs_file
from flankfilm.files.folder import refuse_irregular
from flankfilm.scene import Scene, template
from flankfilm.scene.reader import read_text

__all__ = ["Opened", "SceneFiles", "python_of"]

EXAMPLES = Path(__file__).parents[2] / "examples"
"""Of the repository; an installed package has the template alone."""

SCENES, GEAR_DATA = (".toml",), (".rexs", ".rexsj", ".rexsz")

DEEPEST = 2
"""Levels of folders in which files are listed."""

MOST = 500
"""Files that are listed."""


@dataclass(frozen=True)
class Opened:
    """A document with where it is from.

    Attributes
    ----------
    document : Document
    place : Place
        Where the files are that it names.
    name : str
        Under which it is saved, from the root; empty for none yet.
    digest : str
        Of the file as it was opened or saved; empty without one.
    notes : tuple of str
        What an import left out.
    """

    document: Document
    place: Place
    name: str = ""
    digest: str = ""
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class SceneFiles:
    """Scenes below a folder.

    Attributes
    ----------
    root : Path
    """

    root: Path

    @property
    def place(self) -> Place:
        """The root as the place of a scene."""
        return Place(self.root, self.root)

    def listed(self) -> tuple[str, ...]:
        """Names of scenes and gear data below the root, hidden folders and links left out."""
        names: list[str] = []
        for folder, folders, files in os.walk(self.root):
            here = Path(folder).relative_to(self.root)
            deep = len(here.parts) >= DEEPEST
            folders[:] = [] if deep else sorted(name for name in folders if not name.startswith("."))
            ours = (here / name for name in sorted(files) if Path(name).suffix in (*SCENES, *GEAR_DATA))
            names += [path.as_posix() for path in ours if not (self.root / path).is_symlink()]
        return tuple(names[:MOST])

    def examples(self) -> tuple[str, ...]:
        """Names of the examples."""
        return tuple(sorted(path.stem for path in EXAMPLES.glob("*.toml")))

    def open(self, name: str) -> Opened:
        """Open a scene, or make one of gear data.

        Parameters
        ----------
        name : str
            From the root.

        Raises
        ------
        InputError
            Where it is outside the root, cannot be read, or is no scene.
        """
        path = self.place.inside(name)
        if path.suffix in GEAR_DATA:
            brought = imported(path)
            return Opened(Document.read(brought.text, name), self.place, "", "", brought.notes)
        if path.suffix not in SCENES:
            raise InputError.at(name, "", "must end in .toml, .rexs, .rexsj or .rexsz", "Choose a scene")
        text = read_text(path)
        return Opened(Document.read(text, name), Place(self.root, path.parent), name, _digest(text))

    def example(self, name: str) -> Opened:
        """Open a copy of an example, or the template.

        Parameters
        ----------
        name : str
            One of `examples`; empty for the template.

        Raises
        ------
        InputError
            Where there is no such example.
        """
        if not name:
            return Opened(Document.read(template()), self.place)
        if name not in self.examples():
            raise InputError.at("example", name[:200], "is not there", "Choose one of the list")
        path = EXAMPLES / f"{name}.toml"
        return Opened(Document.read(read_text(path)), Place(EXAMPLES, EXAMPLES))

    def save(self, opened: Opened, name: str) -> Opened:
        """Write a document to a file; whole, or not at all.

        Parameters
        ----------
        opened : Opened
        name : str
            From the root; ends in .toml.

        Raises
        ------
        InputError
            Where that is outside the root, no scene's name, or a file that somebody else has written meanwhile.
        """
        path = self.place.inside(name)
        if path.suffix not in SCENES or path.name.startswith("."):
            raise InputError.at(name[:200], "", "must end in .toml", "Such as my_pair.toml")
        refuse_irregular(path)
        if path.exists() and _digest(read_text(path)) not in (opened.digest, _digest(opened.document.text)):
            raise InputError.at(
                name[:200], "", "was written by somebody else meanwhile", "Save it by another name"
            )
        with replacing(path) as beside:
            beside.write_text(opened.document.text, encoding="utf-8")
        place = Place(self.root, path.parent) if opened.place.root == self.root else opened.place
        return Opened(opened.document, place, name, _digest(opened.document.text), opened.notes)

    def save_gear_data(self, scene: Scene, name: str) -> tuple[str, ...]:
        """Write the pair of a scene as REXS; give what was left out.

        Parameters
        ----------
        scene : Scene
            Without faults.
        name : str
            Of a file that must not exist yet, from the root; ends in .rexs, .rexsj or .rexsz.

        Raises
        ------
        InputError
            Where the name is outside the root, another one's, or the pair is none that REXS has.
        """
        path = self.place.inside(name)
        if path.suffix not in GEAR_DATA:
            raise InputError.at(name[:200], "", "must end in .rexs, .rexsj or .rexsz", "Such as my_pair.rexs")
        if path.exists():
            raise InputError.at(name[:200], "", "exists already and is kept", "Save it by another name")
        content, left_out = rexs_file(gear_pair(scene), scene.title or path.stem, path)
        with replacing(path) as beside:
            beside.write_bytes(content)
        return left_out


def python_of(document: Document, name: str) -> str:
    """Python that computes the same scene.

    Parameters
    ----------
    document : Document
    name : str
        Of the folder of results.

    Examples
    --------
    >>> print(python_of(Document('wants = ["geometry"]'), "out"))
    import flankfilm as ff
    <BLANKLINE>
    SCENE = \"\"\"
    wants = ["geometry"]
    \"\"\"
    <BLANKLINE>
    results = ff.run(ff.parse_scene(SCENE), 'out')
    print(results.dataset)
    """
    text = document.text.strip("\n")
    plain = text.isprintable() or all(c.isprintable() or c == "\n" for c in text)
    scene = f'"""\n{text}\n"""' if plain and '"""' not in text and "\\" not in text else repr(document.text)
    return (
        f"import flankfilm as ff\n\nSCENE = {scene}\n\n"
        f"results = ff.run(ff.parse_scene(SCENE), {name!r})\nprint(results.dataset)"
    )


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()
