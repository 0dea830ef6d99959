#!/usr/bin/python3
"""Installed files, and the package of them, made from the tree as it was built."""

from __future__ import annotations

import gzip
import hashlib
import os
import re
import shutil
import subprocess
import unittest
from pathlib import Path

import h5py

from support import LIMPID, ROOT, SystemTest, limpid

BUILD = LIMPID.parents[1]


def tool(name: str) -> str:
    path = shutil.which(name)
    if path is None:
        raise unittest.SkipTest(f"{name} is not installed")
    return path


class Run(SystemTest):
    def must(self, *words: str | Path, **how) -> str:
        done = subprocess.run(list(map(str, words)), capture_output=True, text=True, timeout=250, **how)
        self.assertEqual(done.returncode, 0, f"{words}\n{done.stdout}{done.stderr}")
        return done.stdout


class Package(Run):
    deb: Path
    common: Path  # what the library needs as well
    root: Path

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        if "LIMPID_SANITIZE:STRING=\n" not in (BUILD / "CMakeCache.txt").read_text():
            raise unittest.SkipTest("a sanitized build is not shipped")
        tool("dpkg-shlibdeps")
        cls.deb, cls.common = cls.pack("first")
        cls.root = cls.directory / "root"
        for deb in (cls.deb, cls.common):
            subprocess.run(["dpkg", "-x", deb, cls.root], check=True)

    @classmethod
    def pack(cls, name: str, *more: str, umask: int = 0o022) -> tuple[Path, Path]:
        out = cls.directory / name
        done = subprocess.run(["cpack", "--config", BUILD / "CPackConfig.cmake", "-B", out, *more], umask=umask,
                              cwd=BUILD, capture_output=True, text=True, timeout=250)  # fmt: skip
        if done.returncode != 0:
            raise AssertionError(done.stdout + done.stderr)
        (deb,), (common,) = out.glob("limpid_*.deb"), out.glob("limpid-common_*.deb")
        return deb, common

    def test_python_finds_its_package_and_the_program(self) -> None:
        modules = self.root / "usr/lib/python3/dist-packages"
        self.assertEqual({path.name for path in modules.rglob("*") if path.suffix not in (".py", ".so")},
                         {"limpid", "study", "studies", "py.typed", "README.md"})
        environment = {key: value for key, value in os.environ.items() if key != "LIMPID"}
        said = self.must("python3", "-c", "import limpid; print(limpid.program.find_program())",
                         env={**environment, "PYTHONPATH": str(modules), "PYTHONDONTWRITEBYTECODE": "1"})
        self.assertEqual(said.strip(), str(self.root / "usr/bin/limpid"))

    def test_links_of_its_pages_lead_to_files_of_its_own(self) -> None:
        doc = self.root / "usr/share/doc/limpid"
        pages = [path for path in self.root.rglob("*") if path.suffix in (".html", ".md")]
        self.assertLessEqual({doc / "manual.html", doc / "examples/lessons/README.md"}, set(pages))
        for page in pages:
            links = r'(?:href|src)="([^"]*)"' if page.suffix == ".html" else r"\]\(([^)\s]*)"
            for link in re.findall(links, page.read_text()):
                if not re.match(r"#|data:|https?:", link):
                    self.assertTrue((page.parent / link.partition("#")[0]).exists(), f"{page}: {link}")

    def test_lintian_accepts_it(self) -> None:
        said = self.must(tool("lintian"), "--allow-root", "--fail-on", "none", "--no-cfg", self.deb, self.common)
        # The known warning: appstream 1.0 asks for a home page, and there is none.
        known = "W: limpid: appstream-metadata-validation-failed "
        self.assertEqual([line for line in said.splitlines() if not line.startswith(known)], [])

    def test_the_library_has_packages_of_its_own(self) -> None:
        library, dev = (next(self.deb.parent.glob(f"{name}_*.deb")) for name in ("liblimpid0.*", "liblimpid-dev"))
        version = self.must("dpkg-deb", "-f", self.deb, "Version").strip()
        for deb in (library, dev, self.deb):
            self.assertIn(f"limpid-common (= {version})", self.must("dpkg-deb", "-f", deb, "Depends"))
        self.assertIn(f"{library.name.split('_')[0]} (= {version})", self.must("dpkg-deb", "-f", dev, "Depends"))
        self.assertRegex(self.must("dpkg-deb", "-c", library), r"/usr/lib/\S*liblimpid\.so\.\d+\.\d+\.\d+\n")
        listed = self.must("dpkg-deb", "-c", dev)
        for name in ("include/limpid/limpid.h", "cmake/limpid/limpidConfig.cmake", "pkgconfig/limpid.pc",
                     "examples/library/own_loop.cpp", "liblimpid.so "):
            self.assertIn(name, listed)
        said = self.must(tool("lintian"), "--allow-root", "--fail-on", "none", "--no-cfg", library, dev)
        self.assertEqual([line for line in said.splitlines() if line.startswith("E:")], [])

    # Its scene has a model that limpid-model reads.
    LOOP = """#include <limpid/limpid.h>
#include <cstdio>
int main(int, char** words) {
  limpid::LoopOptions options;
  options.arm = "touch.urdf";
  options.scene = words[1];
  limpid::SimulatedLoop loop(options);
  loop.step({loop.tip()});
  std::printf("%zu joints\\n", loop.joints());
}
"""

    def test_the_library_runs_without_the_program_and_without_opengl(self) -> None:
        library, dev = (next(self.deb.parent.glob(f"{name}_*.deb")) for name in ("liblimpid0.*", "liblimpid-dev"))
        root = self.out("")
        for deb in (library, dev, self.common):
            needed = self.must("dpkg-deb", "-f", deb, "Depends")
            self.assertNotRegex(needed, r"\blimpid \(|libgl|libegl|libglfw|libx11|libepoxy|libav")
            self.must("dpkg", "-x", deb, root)
        folder = self.out("")
        folder.mkdir()
        source, program, scene = (folder / name for name in ("loop.cpp", "loop", "scene.toml"))
        source.write_text(self.LOOP)
        (folder / "tetrahedron.obj").write_text(
            "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
        scene.write_text('[[mesh]]\nname = "a"\nfile = "tetrahedron.obj"\nposition = [0.5, 0, 0]\nstiffness = 500\n')
        (shared,) = root.rglob("liblimpid.so")
        self.must("g++", "-std=c++20", f"-I{root}/usr/include", source, "-o", program, f"-L{shared.parent}", "-llimpid")
        environment = os.environ | {"LD_LIBRARY_PATH": str(shared.parent)}
        self.assertEqual(self.must(program, scene, env=environment), "3 joints\n")
        self.assertEqual({path.name for path in (root / "usr/libexec/limpid").iterdir()}, {"limpid-model", "limpid-session"})

    def test_its_version_is_the_programs(self) -> None:
        version = self.must("dpkg-deb", "-f", self.deb, "Version").strip()
        self.assertEqual(f"limpid {version}".split("-")[0], limpid("--version").out.strip())

    def test_the_same_tree_gives_the_same_bytes(self) -> None:
        # Packed with little compression, which saves most of the work, under a strict umask.
        again = self.pack("again", "-D", "CPACK_DEBIAN_COMPRESSION_TYPE=none", umask=0o077)
        for pair in zip((self.deb, self.common), again):
            for part in ("--fsys-tarfile", "--ctrl-tarfile"):
                first, second = (subprocess.check_output(["dpkg-deb", part, deb]) for deb in pair)
                self.assertEqual(hashlib.sha256(first).digest(), hashlib.sha256(second).digest(), (pair, part))

    def test_the_programs_name_no_place_where_they_were_built(self) -> None:
        for program in (self.root / "usr/libexec/limpid").iterdir():
            with self.subTest(program.name):
                for place in {ROOT, BUILD}:
                    self.assertNotIn(str(place).encode() + b"/", program.read_bytes())

    def test_it_runs_where_it_was_unpacked(self) -> None:
        program = self.root / "usr/bin/limpid"
        out = self.out()
        self.must(program, "run", "--duration", "0.1", "--record", out, "--picture", out.with_suffix(".png"))
        self.assertTrue(out.with_suffix(".png").exists())
        doctor = subprocess.run([program, "doctor"], capture_output=True, text=True, timeout=120)
        assets = re.search(r"assets +(.*)", doctor.stdout)
        self.assertEqual(assets[1], str((self.root / "usr/share/limpid").resolve()))
        self.assertIn(str((self.root / "usr/libexec/limpid/limpid-model").resolve()), doctor.stdout)

    def test_there_is_a_manual_page_of_every_command(self) -> None:
        pages = self.root / "usr/share/man/man1"

        def below(*above: str) -> list[tuple]:
            """Commands below one, and those below these."""
            parts = limpid(*above, "--help").out.split("Subcommands:\n")
            names = re.findall(r"^  (\w+)", parts[1], re.M) if len(parts) > 1 else []
            return [each for name in names for each in [(*above, name), *below(*above, name)]]

        commands = below()
        self.assertGreater(len(commands), 10)
        self.assertIn(("devices", "look"), commands)
        self.assertEqual({page.name for page in pages.iterdir()},
                         {"limpid.1.gz"} | {f"limpid-{'-'.join(command)}.1.gz" for command in commands})  # fmt: skip
        for command in commands:
            text = gzip.decompress((pages / f"limpid-{'-'.join(command)}.1.gz").read_bytes()).decode()
            text = text.replace("\\", "")
            for option in re.findall(r"^ +(--[\w-]+)", limpid(*command, "--help").out, re.M):
                self.assertIn(option, text, command)

    def test_the_manual_pages_are_well_formed(self) -> None:
        man = tool("man")
        for page in (self.root / "usr/share/man/man1").iterdir():
            done = subprocess.run([man, "--warnings", "-E", "UTF-8", "-l", "-Tutf8", "-Z", page],
                                  capture_output=True, text=True,
                                  env=os.environ | {"LC_ALL": "C.UTF-8", "MANROFFSEQ": "", "MANWIDTH": "80"})  # fmt: skip
            self.assertEqual((done.returncode, done.stderr), (0, ""), page.name)

    def test_every_file_is_there_and_readable_by_all(self) -> None:
        for name in (
            "etc/security/limits.d/limpid.conf",
            "usr/lib/udev/rules.d/70-limpid.rules",
            "usr/share/applications/limpid.desktop",
            "usr/share/bash-completion/completions/limpid",
            "usr/share/doc/limpid/copyright",
            "usr/share/doc/limpid/manual.html",
            "usr/share/fish/vendor_completions.d/limpid.fish",
            "usr/share/icons/hicolor/48x48/apps/limpid.png",
            "usr/share/icons/hicolor/scalable/apps/limpid.svg",
            "usr/share/limpid/assets/scenes/table.toml",
            "usr/share/metainfo/org.limpid.limpid.metainfo.xml",
            "usr/share/mime/packages/limpid.xml",
            "usr/share/zsh/vendor-completions/_limpid",
        ):
            self.assertTrue((self.root / name).is_file(), name)
        for path in self.root.rglob("*"):
            if not path.is_symlink():
                self.assertEqual(path.stat().st_mode & 0o755, path.stat().st_mode & 0o777, path)
                self.assertTrue(path.stat().st_mode & 0o044 == 0o044, path)

    def test_desktop_entry_and_app_page_are_valid(self) -> None:
        share = self.root / "usr/share"
        self.must(tool("desktop-file-validate"), share / "applications/limpid.desktop")
        page = share / "metainfo/org.limpid.limpid.metainfo.xml"
        done = subprocess.run([tool("appstreamcli"), "validate", "--no-net", "--pedantic", page],
                              capture_output=True, text=True)  # fmt: skip
        faults = re.findall(r"^[EWP]: .* (\S+)$", done.stdout, re.M)
        self.assertEqual(set(faults) - {"url-homepage-missing"}, set(), done.stdout + done.stderr)


class WithoutAPackage(Run):
    """`cmake --install --prefix ~/.local`, of somebody whose home is empty."""

    def test_python_finds_its_package_and_the_program(self) -> None:
        home = self.out("")
        home.mkdir(parents=True)
        environment = {key: value for key, value in os.environ.items() if key not in ("LIMPID", "PYTHONPATH")}
        environment |= {"HOME": str(home), "PATH": "/usr/bin:/bin"}
        self.must("cmake", "--install", BUILD, "--prefix", home / ".local", env=environment)
        said = self.must("python3", "-c", "import limpid, limpid.studies.stiffness\n"
                         "print(limpid.program.find_program(), len(limpid.run(duration=0.1)))", env=environment,
                         cwd=home)  # fmt: skip
        self.assertEqual(said.split(), [str(home / ".local/bin/limpid"), "100"])
        lessons = home / ".local/share/doc/limpid/examples/lessons"
        figures = self.out("")
        figures.mkdir()
        self.must("python3", "drift.py", cwd=lessons, env=environment | {"LESSONS": str(figures)})
        self.assertTrue((figures / "drift.svg").exists())

    def test_a_tree_that_was_moved_runs_where_it_is(self) -> None:
        """Assets are found from the program's place, not from the place of the build."""
        link = BUILD / "share/limpid"
        if ROOT.resolve() not in BUILD.resolve().parents:
            self.skipTest("was built elsewhere")
        self.assertFalse(os.path.isabs(os.readlink(link)))
        self.assertEqual(link.resolve(), ROOT.resolve())


class Sessions(Run):
    """Type of a file by the desktop."""

    def setUp(self) -> None:
        tool("gio")
        self.data = self.out("")
        packages = self.data / "mime/packages"
        packages.mkdir(parents=True)
        common = Path("/usr/share/mime/packages/freedesktop.org.xml")
        if not common.exists():
            self.skipTest("shared-mime-info is not installed")
        shutil.copy(common, packages)
        shutil.copy(ROOT / "assets/desktop/limpid.xml", packages)
        self.must(tool("update-mime-database"), self.data / "mime")

    def kind(self, file: Path) -> str:
        environment = os.environ | {"XDG_DATA_HOME": str(self.data), "XDG_DATA_DIRS": str(self.data)}
        said = self.must("gio", "info", "-a", "standard::content-type", file, env=environment)
        return said.split("standard::content-type: ")[1].strip()

    def test_sessions_of_all_sorts_are_known(self) -> None:
        ways = (["run"], ["run", "--twin"], ["run", "--device", ROOT / "assets/devices/planar2.urdf"],
                ["run", "--scene", ROOT / "assets/scenes/gears.toml",
                 "--hand", ROOT / "assets/hands/gears.csv"])  # fmt: skip
        for way in ways:
            out = self.out()
            self.must(LIMPID, *way, "--duration", "0.1", "--record", out)
            self.assertEqual(self.kind(out), "application/x-limpid-session", way)
        for shipped in (ROOT / "assets/sessions").glob("*.h5"):
            self.assertEqual(self.kind(shipped), "application/x-limpid-session", shipped)

    def test_other_hdf5_is_left_to_others(self) -> None:
        out = self.out()
        with h5py.File(out, "w") as file:
            file["numbers"] = [1, 2, 3]
        self.assertEqual(self.kind(out), "application/x-hdf")


class Version(Run):
    """Versions, in repositories of the test's own."""

    def setUp(self) -> None:
        tool("git")
        self.source = self.out("")
        (self.source / "tree").mkdir(parents=True)
        self.source /= "tree"
        (self.source / "CHANGELOG.md").write_text("")

    def git(self, *words: str) -> str:
        names = ["-c", "user.name=a", "-c", "user.email=a@b"]
        return self.must("git", *names, *words, cwd=self.source).strip()

    def commit(self) -> str:
        if not (self.source / ".git").exists():
            self.git("init", "-q")
        self.git("add", "-A")
        self.git("commit", "-q", "--allow-empty", "-m", "x")
        return self.git("rev-parse", "--short=7", "HEAD")

    def version(self) -> str:
        into = self.out("")
        into.mkdir()
        self.must("cmake", f"-DSOURCE={self.source}", f"-DINTO={into}", "-DVERSION=1.2.3",
                  "-P", ROOT / "app/version.cmake")  # fmt: skip
        return re.search(r"limpid_version (\S+)\)", (into / "version.cmake").read_text())[1]

    def test_commits_since_the_release_are_counted(self) -> None:
        first = self.commit()
        self.assertEqual(self.version(), f"1.2.3+1.g{first}")
        self.git("tag", "v1.2.3")
        self.assertEqual(self.version(), "1.2.3")
        self.commit()
        second = self.commit()
        self.assertEqual(self.version(), f"1.2.3+2.g{second}")

    def test_changed_files_are_said(self) -> None:
        first = self.commit()
        (self.source / "CHANGELOG.md").write_text("more")
        self.assertEqual(self.version(), f"1.2.3+1.g{first}.changed")

    def test_an_archive_in_somebody_elses_repository_is_a_release(self) -> None:
        inner = self.source
        self.source = inner.parent
        self.commit()
        self.source = inner
        self.assertEqual(self.version(), "1.2.3")


if __name__ == "__main__":
    unittest.main()
