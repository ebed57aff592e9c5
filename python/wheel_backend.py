"""Builds the wheel of the Python package: the hooks that pip and other front ends call (PEP 517).

CMake builds the extension module and says which files belong to the package. This file packs them.
It uses the standard library alone, so that a wheel can be built without a network.

The setting `build-dir` (`pip wheel . --config-settings=build-dir=build/release`) names a folder in
which CMake has built the package already. Without it the package, and nothing else, is built below
build/wheel. `python3 python/wheel_backend.py FOLDER` writes a wheel without a front end.
"""

import base64
import hashlib
import io
import os
import pathlib
import re
import subprocess
import sys
import sysconfig
import tarfile
import tempfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PYTHON_TAG = f"cp{sys.version_info.major}{sys.version_info.minor}"
TAG = f"{PYTHON_TAG}-{PYTHON_TAG}-" + re.sub(r"[-.]", "_", sysconfig.get_platform())
# Archives have the same bytes whenever they are made.
TIME = (1980, 1, 1, 0, 0, 0)


def _project():
    """Returns the version and the description, which CMakeLists.txt states."""
    text = (ROOT / "CMakeLists.txt").read_text()
    found = re.search(r'project\(planetree VERSION (\S+).*?DESCRIPTION "([^"]+)"', text, re.DOTALL)
    return found[1], found[2]


def _metadata():
    version, description = _project()
    # NumPy 2 has another layout of types, which pybind11 knows from 2.12 on; Debian 12 has 2.10.
    return (
        f"Metadata-Version: 2.1\nName: planetree\nVersion: {version}\nSummary: {description}\n"
        "License: Apache-2.0\nLicense-File: LICENSE\nRequires-Python: >=3.9\n"
        "Requires-Dist: numpy <2\n"
    )


def _name():
    return f"planetree-{_project()[0]}"


def _build():
    """Builds the package for this interpreter, and returns the folder."""
    folder = ROOT / "build" / "wheel" / PYTHON_TAG
    # The interpreter behind a virtual environment, which may be gone at the next build.
    python = os.path.realpath(sys.executable)
    options = {
        "CMAKE_BUILD_TYPE": "Release",
        "CMAKE_UNITY_BUILD": "ON",
        "CMAKE_UNITY_BUILD_BATCH_SIZE": "8",
        "PLANETREE_BUILD_TESTS": "OFF",
        "PLANETREE_BUILD_TOOLS": "OFF",
        "PLANETREE_PYTHON": python,
    }
    definitions = [f"-D{name}={value}" for name, value in options.items()]
    # Another compiler may warn of what g++ 12 does not.
    configure = ["cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", "--compile-no-warning-as-error"]
    subprocess.run([*configure, *definitions], check=True)
    targets = ["planetree_python", "planetree_python_scripts"]
    subprocess.run(["cmake", "--build", folder, "--target", *targets], check=True)
    return folder


def _package_files(build_folder):
    """Returns the contents of the files of the package, by their path in the wheel."""
    with tempfile.TemporaryDirectory() as stage:
        install = ["cmake", "--install", build_folder, "--component", "python", "--strip"]
        subprocess.run([*install, "--prefix", stage], check=True)
        roots = [path.parent for path in pathlib.Path(stage).rglob("planetree/__init__.py")]
        module = "_planetree" + sysconfig.get_config_var("EXT_SUFFIX")
        if not roots or not (roots[0] / module).is_file():
            raise RuntimeError(f"{build_folder} has no {module}; build planetree_python there")
        files = sorted(path for path in roots[0].iterdir() if path.is_file())
        return {f"planetree/{path.name}": path.read_bytes() for path in files}


def _hash(content):
    digest = hashlib.sha256(content).digest()
    return "sha256=" + base64.urlsafe_b64encode(digest).rstrip(b"=").decode()


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """Writes a wheel to a folder, and returns the name of the file."""
    build_folder = (config_settings or {}).get("build-dir") or _build()
    files = _package_files(build_folder)
    info = f"{_name()}.dist-info"
    wheel = f"Wheel-Version: 1.0\nGenerator: planetree\nRoot-Is-Purelib: false\nTag: {TAG}\n"
    files[f"{info}/METADATA"] = _metadata().encode()
    files[f"{info}/WHEEL"] = wheel.encode()
    files[f"{info}/LICENSE"] = (ROOT / "LICENSE").read_bytes()
    record = [f"{path},{_hash(content)},{len(content)}\n" for path, content in files.items()]
    files[f"{info}/RECORD"] = ("".join(record) + f"{info}/RECORD,,\n").encode()

    name = f"{_name()}-{TAG}.whl"
    with zipfile.ZipFile(pathlib.Path(wheel_directory) / name, "w") as archive:
        for path, content in files.items():
            entry = zipfile.ZipInfo(path, TIME)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o755 if path.endswith(".so") else 0o644) << 16
            archive.writestr(entry, content)
    return name


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    """Writes the metadata alone. Without this hook a front end would build the package twice."""
    info = pathlib.Path(metadata_directory) / f"{_name()}.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(_metadata())
    return info.name


def build_sdist(sdist_directory, config_settings=None):
    """Writes the sources that git knows to a folder, and returns the name of the file."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True)
    name = f"{_name()}.tar.gz"
    with tarfile.open(pathlib.Path(sdist_directory) / name, "w:gz") as archive:
        for path in listed.stdout.decode().rstrip("\0").split("\0"):
            archive.add(ROOT / path, f"{_name()}/{path}", recursive=False)
        content = _metadata().encode()
        entry = tarfile.TarInfo(f"{_name()}/PKG-INFO")
        entry.size = len(content)
        archive.addfile(entry, io.BytesIO(content))
    return name


if __name__ == "__main__":
    print(build_wheel(sys.argv[1]))
