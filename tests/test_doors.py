"""One door: files that a user may name are opened by `ai.files.reading` alone, and no file's word becomes code."""

import ast
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[1]
OPENING = {
    "open", "io.open", "os.open", "read_text", "read_bytes", "np.load", "np.loadtxt", "np.genfromtxt", "np.fromfile",
    "np.memmap", "json.load", "pickle.load", "shutil.copy", "shutil.copy2", "shutil.copyfile", "shutil.copytree",
    "shutil.unpack_archive", "ZipFile", "TarFile", "extractall", "pygame.image.load", "pygame.font.Font",
    "mmap.mmap", "sqlite3.connect",
}  # fmt: skip
STARTING = {
    "eval", "exec", "__import__", "import_module", "pickle.load", "pickle.loads", "gymnasium.make",
    "self._gymnasium.make", "spec.loader.exec_module", "run_path", "run_module", "os.system", "os.popen", "Popen",
    "subprocess.run",
}  # fmt: skip
# Calls that a module makes all the same, and why no file of a stranger's is behind them.
OPENED = {
    "ai.files.reading": ({"Path(path).open", "np.load", "zipfile.ZipFile"}, "the door"),
    "ai.files.writing": ({"os.open", "temporary.open", "path.open"}, "writes, appends, and waits for the disk"),
    "ai.cli.command_line": ({"os.open"}, "the null device"),
    "ai.pilots.child": ({"os.open"}, "the null device"),
    "ai.sweep.trial": ({"path.read_bytes"}, "what it has just written"),
    "game.audio.mixer": ({"self.open"}, "the sound device"),
    "game.core.catalogue": ({"path.read_bytes"}, "comes with the program"),
    "game.core.shelf": ({"shutil.copytree"}, "of plain files alone, links as links"),
    "game.drawing.typeface": ({"pygame.font.Font"}, "comes with the program"),
    "game.export.gif": ({"path.open"}, "writes"),
    "game.scenes.learn.one_file": ({"MICROLANDER.read_text"}, "comes with the program"),
    "game.scenes.train.laboratory": ({"self.open"}, "a part of the panel"),
    "game.start": ({"context.sound.open"}, "the sound device"),
    "tranquility.__main__": ({"os.open"}, "the null device"),
}
STARTED = {
    "ai.pilots.child": ({"spec.loader.exec_module"}, "the file that the player has chosen, in a process of its own"),
    "game.scenes.networks.files": ({"subprocess.Popen"}, "the system's editor"),
    "ai.training.gym_task": ({"self._gymnasium.make"}, "`check_env` stands before every file's name"),
    "game.core.worker": ({"pickle.loads"}, "the pipe to its own worker"),
    "game.core.worker_process": ({"pickle.loads"}, "the pipe from its own window"),
    "game.scenes.learn.path": ({"import_module"}, "names of its own table"),
    "game.scenes": ({"import_module"}, "names of its own table"),
    "game.scenes.ahead": ({"import_module"}, "names of its own table"),
    "tranquility.__main__": ({"import_module"}, "names of its own table"),
}


@cache
def called():
    """Return what is called in each module, as it is written."""
    found = {}
    for folder in ("ai", "engine", "game", "tranquility"):
        for path in sorted((ROOT / folder).rglob("*.py")):
            module = ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                if isinstance(node, ast.Call) and isinstance(node.func, ast.Name | ast.Attribute):
                    found.setdefault(module, set()).add(ast.unparse(node.func))
    return found


def calls(names):
    """Return the calls of these names in each module: as a whole, or what stands behind the last dot."""
    return {
        module: {each for each in said if each in names or ("." in each and each.rpartition(".")[2] in names)}
        for module, said in called().items()
    }


def unexpected(names, allowed):
    return {module: more for module, said in calls(names).items() if (more := said - allowed.get(module, (set(),))[0])}


def test_no_module_but_the_door_opens_a_file_that_a_user_may_name():
    own = {"read_text", "read_bytes"}  # the door's own functions, imported by name
    strangers = {module: more - own for module, more in unexpected(OPENING, OPENED).items() if more - own}
    assert not strangers, f"read with ai.files, or say here why not: {strangers}"


def test_no_name_that_a_file_gives_becomes_code():
    strangers = unexpected(STARTING, STARTED)
    assert not strangers, f"say here why no file decides what is started: {strangers}"


def test_every_exception_is_still_needed():
    for names, allowed in ((OPENING, OPENED), (STARTING, STARTED)):
        made = calls(names)
        for module, (said, _) in allowed.items():
            assert said <= made.get(module, set()), f"{module} no longer calls {said - made.get(module, set())}"
