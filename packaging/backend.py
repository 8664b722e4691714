"""Builds the wheel of pyroclast by CMake; pip calls it (PEP 517, PEP 660). It needs no package but Python itself.

    pip install --no-index .
    pip install --no-index -e .

The Python that builds is the one that the package is for. Its build tree stays in build/, so that a second build is
short. The environment variable PYROCLAST_BUILD names a tree that is built already, by this Python, and is taken as it
is. A wheel holds the package, and in the folders of the environment the program, the library and its headers; an
editable one names the package in the build tree, whose files are those of the source tree.
"""

from __future__ import annotations

import base64
import hashlib
import os
import subprocess
import sys
import sysconfig
import tempfile
import tomllib
import zipfile
from pathlib import Path

_ROOT = Path(__file__).resolve().parents[1]
_PROJECT = tomllib.loads((_ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
_NAME = f"{_PROJECT['name']}-{_PROJECT['version']}"
_TAG = f"cp{sys.version_info.major}{sys.version_info.minor}-cp{sys.version_info.major}{sys.version_info.minor}-" + \
    sysconfig.get_platform().replace("-", "_").replace(".", "_")
_PACKAGES = "share/pyroclast/python"
_OWN_BUILD = _ROOT / "build" / f"python-{sys.version_info.major}.{sys.version_info.minor}"
_BUILT = os.environ.get("PYROCLAST_BUILD")
_BUILD = Path(_BUILT).resolve() if _BUILT else _OWN_BUILD


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    _make()
    with tempfile.TemporaryDirectory() as prefix:
        _run("cmake", "--install", _BUILD, "--prefix", prefix)
        return _pack(wheel_directory, dict(_placed(Path(prefix))))


def build_editable(wheel_directory, config_settings=None, metadata_directory=None):
    _make()
    return _pack(wheel_directory, {f"{_NAME}.pth": (f"{_BUILD / 'python'}\n".encode(), 0o644)})


def build_sdist(sdist_directory, config_settings=None):
    raise NotImplementedError("a source distribution is the repository itself: git archive")


def _make():
    """The interpreter is the one that asks: CMake would take another one, unhinted."""
    if _BUILT:
        return
    _run("cmake", "-S", _ROOT, "-B", _BUILD, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DPYROCLAST_TESTS=OFF",
         "-DPYROCLAST_SETS=all", "-DPYROCLAST_UNITY=ON",
         f"-DPYROCLAST_PYTHON={sys.executable}")
    _run("cmake", "--build", _BUILD)


def _run(*words):
    subprocess.run([str(word) for word in words], check=True)


def _placed(prefix):
    """Name in the wheel, contents and mode of each installed file."""
    for path in sorted(prefix.rglob("*")):
        if not path.is_file():
            continue
        name = path.relative_to(prefix).as_posix()
        if name.startswith(f"{_PACKAGES}/"):
            name = name.removeprefix(f"{_PACKAGES}/")
        elif name.startswith("bin/"):
            name = f"{_NAME}.data/scripts/{name.removeprefix('bin/')}"
        else:
            name = f"{_NAME}.data/data/{name}"
        yield name, (path.read_bytes(), path.stat().st_mode & 0o777)


def _metadata():
    lines = ["Metadata-Version: 2.1", f"Name: {_PROJECT['name']}", f"Version: {_PROJECT['version']}",
             f"Summary: {_PROJECT['description']}", f"Requires-Python: {_PROJECT['requires-python']}",
             *(f"Requires-Dist: {name}" for name in _PROJECT["dependencies"])]
    wheel = ["Wheel-Version: 1.0", "Generator: pyroclast", "Root-Is-Purelib: false", f"Tag: {_TAG}"]
    return {f"{_NAME}.dist-info/{name}": ("\n".join(text + [""]).encode(), 0o644)
            for name, text in (("METADATA", lines), ("WHEEL", wheel))}


def _pack(folder, files):
    name = f"{_NAME}-{_TAG}.whl"
    record = f"{_NAME}.dist-info/RECORD"
    listed = []
    with zipfile.ZipFile(os.path.join(folder, name), "w", zipfile.ZIP_DEFLATED) as wheel:
        for path, (contents, mode) in (files | _metadata()).items():
            digest = base64.urlsafe_b64encode(hashlib.sha256(contents).digest()).rstrip(b"=").decode()
            listed.append(f"{path},sha256={digest},{len(contents)}")
            _write(wheel, path, contents, mode)
        _write(wheel, record, "\n".join([*listed, f"{record},,", ""]).encode(), 0o644)
    return name


def _write(wheel, path, contents, mode):
    info = zipfile.ZipInfo(path, (1980, 1, 1, 0, 0, 0))
    info.external_attr = (0o100000 | mode) << 16
    info.compress_type = zipfile.ZIP_DEFLATED
    wheel.writestr(info, contents)
