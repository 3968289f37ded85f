#!/usr/bin/env python3
"""The packages of cpack, installed and used in a clean root: clean_root.py CPACK BINARY_DIR SOURCE_DIR VERSION.

The root has nothing but the installed Debian packages that a package names, and what those name in turn: what is not named
is not there. The archive's root is smaller still: the C and C++ runtime, EGL with a driver, and X11. In both, pictures are
rendered with and without OpenGL, an example is built against volgi-dev, and what is taken away again leaves nothing. Then
manual pages, completions, the entry for desktops and the list of parts. Exit code 77 (skipped) where there is no dpkg, or neither root nor user name spaces.
"""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SYSTEM = ["libc6", "libstdc++6", "libgcc-s1", "libegl1", "libgl1", "libgl1-mesa-dri", "libx11-6"]  # that the archive expects
failures = []


def check(holds, text):
    if not holds:
        failures.append(text)


def run(*command, **more):
    return subprocess.run([str(c) for c in command], capture_output=True, text=True, timeout=600, **more)


def must(*command, **more):
    done = run(*command, **more)
    if done.returncode != 0:
        sys.exit(f"failed: {' '.join(map(str, command))}\n{done.stdout}{done.stderr}")
    return done.stdout


# --- a root of Debian packages --------------------------------------------------------------------------------------


def installed_packages():
    """Of what is installed: its names (those that it provides, too), and the alternatives of each thing that it needs."""
    needs, names = {}, {}
    form = "${db:Status-Status}|${Package}|${Provides}|${Pre-Depends}, ${Depends}\n"
    for line in must("dpkg-query", "-W", "-f", form).splitlines():
        status, package, provides, depends = line.split("|", 3)
        if status != "installed":
            continue
        needs[package] = depends
        names.setdefault(package, package)
        for other in provides.split(","):
            names.setdefault(other.split("(")[0].strip(), package)
    return names, {package: alternatives(text) for package, text in needs.items()}


def alternatives(text):
    each = [[re.sub(r"\(.*?\)|:\w+", "", other).strip() for other in item.split("|")] for item in text.split(",")]
    return [item for item in each if item != [""]]


def closure(wanted, names, needs):
    found, open_items = set(), list(wanted)
    while open_items:
        choices = open_items.pop()
        package = next((names[c] for c in choices if c in names), None)
        if package is None:
            sys.exit(f"not installed here: {' | '.join(choices)}")
        if package not in found:
            found.add(package)
            open_items += needs[package]
    return found


class Root:
    def __init__(self, folder):
        self.folder, self.packages = folder, set()
        for name in ("bin", "sbin", "lib", "lib64"):
            (folder / "usr" / name).mkdir(parents=True)
            (folder / name).symlink_to(f"usr/{name}")
        for name in ("proc", "dev", "tmp", "var/lib/dpkg/info", "var/lib/dpkg/updates", "var/lib/dpkg/triggers"):
            (folder / name).mkdir(parents=True)
        (folder / "usr/bin/of_others").touch()  # the folder is not our package's alone
        must("mount", "-t", "proc", "proc", folder / "proc")
        must("mount", "--rbind", "/dev", folder / "dev")

    def add(self, packages):
        new = sorted(packages - self.packages)
        self.packages |= packages
        files = []
        for package in new:
            for file in must("dpkg-query", "-L", package).splitlines():
                # Documents and locales are not what a program runs on, and many images are built without.
                if file.startswith("/") and os.path.lexists(file) and not re.match("/usr/share/(doc|man|locale|info)", file):
                    files.append(file[1:])
            for kind in ("list", "md5sums"):
                for file in Path("/var/lib/dpkg/info").glob(f"{package}*.{kind}"):
                    if file.stem.split(":")[0] == package:
                        shutil.copy(file, self.folder / "var/lib/dpkg/info")
        reader = subprocess.Popen(["tar", "-C", "/", "--no-recursion", "-cf", "-", "-T", "-"], stdin=subprocess.PIPE,
                                  stdout=subprocess.PIPE)
        writer = subprocess.Popen(["tar", "-C", self.folder, "--keep-directory-symlink", "-xf", "-"], stdin=reader.stdout)
        reader.stdin.write("\n".join(files).encode())
        reader.stdin.close()
        if writer.wait() != 0 or reader.wait() != 0:
            sys.exit("the root cannot be filled")
        (self.folder / "var/lib/dpkg/status").write_text(must("dpkg-query", "-s", *sorted(self.packages)))

    def files(self):
        """All but what dpkg writes down, and what is not on the disk."""
        apart = [self.folder / p for p in ("proc", "dev", "tmp", "var/lib/dpkg", "var/log")]
        return {str(p) for p in self.walk(self.folder) if not any(p == a or a in p.parents for a in apart)}

    def walk(self, folder):
        for entry in os.scandir(folder):
            if entry.name in ("proc", "dev") and folder == self.folder:
                continue
            yield Path(entry.path)
            if entry.is_dir(follow_symlinks=False):
                yield from self.walk(entry.path)

    def dpkg(self, *arguments):
        return run("dpkg", f"--root={self.folder}", "--log=/dev/null", *arguments)

    def inside(self, *command):
        clean = {"PATH": "/usr/bin:/bin", "HOME": "/tmp", "LC_ALL": "C"}
        return run(shutil.which("chroot"), self.folder, *command, env=clean)

    def close(self):
        for name in ("proc", "dev"):
            run("umount", "-R", "-l", self.folder / name)


# --- use ------------------------------------------------------------------------------------------------------------


def is_png(path):
    return path.is_file() and path.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n" and path.stat().st_size > 200


def use(root, programs, where):
    """The programs of a folder of the root, by their whole names."""
    volgi, demo = f"{programs}/volgi", f"{programs}/volgi-demo"
    scene = f"{programs}/../share/volgi/cornell.glb"
    small = ["--size", "32x32", "--grid", "8", "--set", "val.map=32", "--vpls", "32", "--vals", "4"]
    for command, out in (([volgi, "render", scene, "-o", "/tmp/r.png", *small], "r.png"),
                         ([volgi, "export", scene, "-o", "/tmp/v.vdb", "--grid", "8", "--backend", "cpu"], None),
                         ([demo, "--headless", "--no-settings", "-o", "/tmp/d.png", *small], "d.png"),
                         ([demo, "/tmp/v.vdb", "--headless", "-o", "/tmp/s.png", "--size", "200x200"], "s.png")):
        done = root.inside(*command)
        check(done.returncode == 0, f"{where}: {' '.join(command)}: exit code {done.returncode}: {done.stderr}")
        if out:
            check(is_png(root.folder / "tmp" / out), f"{where}: no {out}")
            (root.folder / "tmp" / out).unlink(missing_ok=True)
    (root.folder / "tmp/v.vdb").unlink(missing_ok=True)


def archive(root, file):
    before = root.files()
    place = root.folder / "opt/some where"  # nobody knew of it when it was built
    place.mkdir(parents=True)
    must("tar", "-C", place, "-xzf", file)
    top = [p.name for p in place.iterdir()]
    check(len(top) == 1 and top[0].startswith("volgi-"), f"archive: unpacks {top}")
    use(root, f"/opt/some where/{top[0]}/bin", "archive")
    doc = place / top[0] / "share/doc/volgi"
    check((doc / "licences/libopenvdb10.0").is_file() or any((doc / "licences").iterdir()), "archive: no licences of its libraries")
    shutil.rmtree(root.folder / "opt")
    check(root.files() == before, f"archive: leaves {root.files() ^ before}")


def debian(root, deb, names, needs):
    wanted = alternatives(must("dpkg-deb", "-f", deb, "Depends"))
    for library in ("libopenvdb", "libembree", "libepoxy", "libegl1"):
        check(any(library in choice for item in wanted for choice in item), f".deb: does not depend on {library}")
    root.add(closure(wanted, names, needs))
    before = root.files()
    done = root.dpkg("-i", deb)
    check(done.returncode == 0, f".deb: dpkg -i: {done.stderr}")
    use(root, "/usr/bin", ".deb")
    check(root.inside("/usr/bin/volgi", "--version").stdout.startswith("volgi "), ".deb: --version")
    done = root.dpkg("-P", "volgi")
    check(done.returncode == 0, f".deb: dpkg -P: {done.stderr}")
    check(root.files() == before, f".deb: leaves {sorted(root.files() ^ before)[:9]}")
    check(not list((root.folder / "var/lib/dpkg/info").glob("volgi*")), ".deb: dpkg still knows it")


def development(root, deb, source, names, needs):
    """A program of somebody else's is built against volgi-dev and runs. Without a compiler here it is installed only."""
    tools = ["g++", "cmake", "ninja-build", "dash"]  # dash: essential, so that nobody names it
    missing = [tool for tool in tools if tool not in names]
    wanted = alternatives(must("dpkg-deb", "-f", deb, "Depends"))
    root.add(closure(wanted + [[tool] for tool in tools if not missing], names, needs))
    before = root.files()
    done = root.dpkg("-i", deb)
    check(done.returncode == 0, f"volgi-dev: dpkg -i: {done.stderr}")
    if missing:
        print(f"skipped: examples/minimal against volgi-dev: not installed here: {', '.join(missing)}")
    else:
        shutil.copytree(source / "examples/minimal", root.folder / "tmp/minimal")
        for command in (["cmake", "-S", "/tmp/minimal", "-B", "/tmp/build", "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                         "-DCMAKE_CXX_COMPILER=/usr/bin/g++"],
                        ["cmake", "--build", "/tmp/build"], ["/tmp/build/minimal"]):
            done = root.inside(*command)
            check(done.returncode == 0, f"volgi-dev: {' '.join(command)}: {done.stdout[-2000:]}{done.stderr[-2000:]}")
        # As install_and_use.sh has it: 0.69 W/m2/sr on the floor.
        light = re.search(r"\d+\.\d+", " ".join(done.stdout.split()[5:]))
        check(light and 0.64 < float(light.group()) < 0.74, f"volgi-dev: minimal says {done.stdout}")
        for made in ("minimal", "build"):
            shutil.rmtree(root.folder / "tmp" / made, ignore_errors=True)
    done = root.dpkg("-P", "volgi-dev")
    check(done.returncode == 0, f"volgi-dev: dpkg -P: {done.stderr}")
    check(root.files() == before, f"volgi-dev: leaves {sorted(root.files() ^ before)[:9]}")
    check(not list((root.folder / "var/lib/dpkg/info").glob("volgi*")), "volgi-dev: dpkg still knows it")


# --- what lies beside the programs ----------------------------------------------------------------------------------


def pages(unpacked, version):
    """The pages name every option that the program does, and say nothing that groff warns of."""
    volgi = unpacked / "usr/bin/volgi"
    manual = unpacked / "usr/share/man/man1"
    for name, command in (("volgi-render", ["render"]), ("volgi-report", ["report"]), ("volgi-inspect", ["inspect"])):
        text = (manual / f"{name}.1").read_text()
        page = text.replace("\\-", "-")
        for option in re.findall(r"^  (?:-\w,)?(--[\w-]+)", must(volgi, *command, "--help"), re.MULTILINE):
            check(f"{option}\\fR" in page, f"{name}.1 does not have {option}")
        check(f"volgi {version}" in text, f"{name}.1 is of another version")
    if shutil.which("groff"):
        for page in manual.glob("*.1"):
            warned = run("groff", "-man", "-ww", "-z", page).stderr
            check(not warned, f"{page.name}: {warned}")


def completions(unpacked):
    def completed(line):
        words = line.split(" ")
        script = (f"source '{unpacked}/usr/share/bash-completion/completions/volgi'; COMP_WORDS=({' '.join(repr(w) for w in words)}); "
                  f"COMP_CWORD={len(words) - 1}; _volgi; printf '%s\\n' \"${{COMPREPLY[@]}}\"")
        return must("bash", "-c", script).split()

    check({"render", "report", "inspect"} <= set(completed("volgi ")), f"bash: commands {completed('volgi ')}")
    check(completed("volgi rend") == ["render"], f"bash: {completed('volgi rend')}")
    check("--animate" in completed("volgi render --anim"), "bash: options")
    check("--animate" not in completed("volgi compare --anim"), "bash: options of another command")
    check(set(completed("volgi render --light ")) == {"full", "direct", "indirect"}, f"bash: values {completed('volgi render --light ')}")
    if shutil.which("zsh"):
        for file in (unpacked / "usr/share/zsh/site-functions").iterdir():
            done = run("zsh", "-n", file)
            check(done.returncode == 0, f"zsh: {done.stderr}")


def desktop(unpacked):
    share = unpacked / "usr/share"
    text = (share / "applications/volgi-demo.desktop").read_text()
    icon = re.search("^Icon=(.*)$", text, re.MULTILINE).group(1)
    check((share / f"icons/hicolor/scalable/apps/{icon}.svg").is_file(), "no icon of that name")
    check((unpacked / "usr/bin" / re.search(r"^Exec=(\S+)", text, re.MULTILINE).group(1)).is_file(), "no program of that name")
    if shutil.which("desktop-file-validate"):
        done = run("desktop-file-validate", share / "applications/volgi-demo.desktop")
        check(done.returncode == 0, done.stdout)


def parts(unpacked, version):
    document = json.loads((unpacked / "usr/share/doc/volgi/volgi.spdx.json").read_text())
    check(document["spdxVersion"] == "SPDX-2.3" and document["dataLicense"] == "CC0-1.0", "SBOM: not SPDX 2.3")
    by_id = {p["SPDXID"]: p for p in document["packages"]}
    check(len(by_id) == len(document["packages"]), "SBOM: a name twice")
    check(by_id["SPDXRef-volgi"]["versionInfo"] == version, "SBOM: another version")
    for relation in document["relationships"]:
        check(relation["relatedSpdxElement"] in by_id, f"SBOM: {relation}")
    said = " ".join(p["comment"] for p in document["packages"])
    for program in ("volgi", "volgi-demo"):
        for library in re.findall(r"^\s*(\S+) => /", must("ldd", unpacked / "usr/bin" / program), re.MULTILINE):
            check(library in said, f"SBOM: {library} is not in it")


def main():
    cpack, binary, source, version = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3]), sys.argv[4]
    if not shutil.which("dpkg-shlibdeps") or not shutil.which("unshare"):
        print("no dpkg-dev or unshare")
        sys.exit(77)
    if "VOLGI_CLEAN_ROOT" not in os.environ:  # mounts of our own, which end with us
        name_space = ["unshare", "--mount", "--propagation", "private"] + ([] if os.geteuid() == 0 else ["--map-root-user"])
        if run(*name_space, "true").returncode != 0:
            print("no name space for mounts")
            sys.exit(77)
        os.environ["VOLGI_CLEAN_ROOT"] = "1"
        os.execvp("unshare", name_space + [sys.executable, *sys.argv])
    newest = re.search(r"^## (\S+)", (source / "CHANGELOG.md").read_text(), re.MULTILINE).group(1)
    check(newest == version, f"CHANGELOG.md begins with {newest}, and this is {version}")
    with tempfile.TemporaryDirectory() as name:
        work = Path(name)
        must(cpack, "--config", binary / "CPackConfig.cmake", "-B", work / "packages", cwd=binary)
        deb, tar = next(work.glob("packages/volgi_*.deb")), next(work.glob("packages/*.tar.gz"))
        dev = next(work.glob("packages/volgi-dev_*.deb"))
        check(deb.name.split("_")[1] == version, f"{deb.name} is not of version {version}")
        names, needs = installed_packages()
        root = Root(work / "root")
        try:
            root.add(closure([[p] for p in SYSTEM], names, needs))
            archive(root, tar)
            debian(root, deb, names, needs)
            development(root, dev, source, names, needs)
        finally:
            root.close()
        unpacked = work / "unpacked"
        must("dpkg-deb", "-x", deb, unpacked)
        pages(unpacked, version)
        completions(unpacked)
        desktop(unpacked)
        parts(unpacked, version)
    print("\n".join(failures) or "the packages hold")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
