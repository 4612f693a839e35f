#!/usr/bin/env python3
"""Every command of the tutorials runs, in a folder that has what a clone has: blocks ```bash one after the other, blocks
```sh beside them, in terminals of their own, until the end of the page. And no page points to what is not there."""
import os
import pathlib
import re
import signal
import subprocess
import tempfile
import unittest

import rostest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]
BLOCK = re.compile(r"^```(bash|sh)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\[[^\]]*\]\(([^)#\s]+)[^)]*\)")


def own_display():
    """An X server without a screen, and its DISPLAY."""
    server = subprocess.Popen(["Xvfb", "-displayfd", "1", "-screen", "0", "1280x900x24", "-nolisten", "tcp"],
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    return server, ":" + server.stdout.readline().strip()


class Docs(unittest.TestCase):
    def run_page(self, name):
        folder = pathlib.Path(tempfile.mkdtemp())
        for part in ("config", "data", "docs", "rviz", "scripts"):
            (folder / part).symlink_to(ROOT / part)
        (folder / "devel").mkdir()
        (folder / "devel" / "setup.bash").write_text(f". {ROOT}/devel/setup.bash\n")
        server, display = own_display()
        self.addCleanup(server.wait)
        self.addCleanup(server.terminate)
        env = dict(os.environ, ROS_HOME=str(folder / ".ros"), HOME=str(folder), DISPLAY=display, LIBGL_ALWAYS_SOFTWARE="1", QT_X11_NO_MITSHM="1")
        blocks = BLOCK.findall((ROOT / "docs" / name).read_text())
        self.assertGreater(len(blocks), 3)
        for number, (kind, commands) in enumerate(blocks):
            shell = ["bash", "-ec", ". devel/setup.bash\n" + commands]
            if kind == "sh":
                log = open(folder / f"terminal_{number}.log", "w")
                process = subprocess.Popen(shell, cwd=folder, env=env, stdout=log, stderr=log, start_new_session=True)
                self.addCleanup(self.end, process, commands, log.name)
                continue
            said = open(folder / "said.log", "w+")
            try:
                code = subprocess.run(shell, cwd=folder, env=env, stdout=said, stderr=said, timeout=120).returncode
            except subprocess.TimeoutExpired:
                code = "no end within two minutes"
            said.seek(0)
            words = said.read()
            self.assertEqual(code, 0, f"{name}: {commands}{words[-2000:]}")
            self.assertNotRegex(words, r"code: [1-9]", f"{name}: {commands}")

    def end(self, process, commands, log):
        """What has a terminal of its own runs until its reader ends it."""
        code = process.poll()
        if code is None:
            os.killpg(process.pid, signal.SIGINT)
            try:
                process.wait(20)
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()
        else:
            self.fail(f"ended with {code}: {commands}{pathlib.Path(log).read_text()[-2000:]}")

    def test_from_your_files(self):
        self.run_page("from_your_files.md")

    def test_connecting_a_device(self):
        self.run_page("connecting_a_device.md")

    def test_writing_a_scene(self):
        self.run_page("writing_a_scene.md")

    def test_every_program_says_how_it_is_called(self):
        programs = [path for path in (ROOT / "devel" / "lib" / "soft_tissue_sim").iterdir() if os.access(path, os.X_OK)]
        self.assertGreaterEqual(len(programs), 9)
        for program in programs:
            done = subprocess.run([str(program), "--help"], capture_output=True, text=True, timeout=20)
            self.assertEqual(done.returncode, 0, program.name)
            self.assertRegex(done.stdout, rf"(?s)^(usage: )?{program.name} .*\bexample: .*{program.name} ", program.name)

    def test_doxygen_and_catkin_lint_have_nothing_to_say(self):
        pages = (ROOT / "docs" / "Doxyfile").read_text() + f"OUTPUT_DIRECTORY = {tempfile.mkdtemp()}\n"
        for command in (["doxygen", "-"], ["catkin_lint", "-q", "--offline", str(ROOT)]):
            done = subprocess.run(command, input=pages, cwd=ROOT, capture_output=True, text=True, timeout=120)
            said = [line for line in (done.stdout + done.stderr).splitlines()
                    if not line.startswith("catkin_lint: cannot load rosdep") and "unknown dependencies" not in line]
            self.assertEqual((done.returncode, said), (0, []))

    def test_pages_point_to_what_is_there(self):
        for page in PAGES:
            for target in LINK.findall(page.read_text()):
                if "://" not in target:
                    self.assertTrue((page.parent / target).exists(), f"{page.relative_to(ROOT)}: {target}")


if __name__ == "__main__":
    rostest.rosrun("soft_tissue_sim", "docs", Docs)
