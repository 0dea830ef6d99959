"""`limpid serve` and the Python package that leads it, and programs that do their worst."""

from __future__ import annotations

import json
import os
import resource
import signal
import subprocess
import sys
import threading
import time
import unittest
from pathlib import Path

import h5py
import numpy
from remote import RemoteTest, limpid
from support import ASSETS, LIMPID

PATH = [(0, 0.19, 0, 0), (0.2, 0.19, 0, 0), (0.8, 0.19, 0, -0.045), (1.0, 0.19, 0, -0.045)]


class TestServe(RemoteTest):
    def test_says_what_it_is(self) -> None:
        about = self.connect().about
        self.assertEqual((about["program"], about["protocol"], about["kind"]), ("limpid", 1, "serve"))
        self.assertIn(about["version"], subprocess.run([LIMPID, "--version"], check=True, text=True,
                                                       capture_output=True).stdout)
        self.assertNotIn("ask", about["verbs"])

    def test_only_the_user_can_reach_it(self) -> None:
        self.assertEqual(self.mode(self.socket), 0o600)
        self.assertEqual(self.mode(self.socket.parent), 0o700)

    def test_settings_are_read_and_set_all_or_none(self) -> None:
        loop = self.connect()
        self.assertEqual(loop.set({"coupling.eta": 0.5, "coupling.kind": "predictive"}),
                         {"coupling.eta": 0.5, "coupling.kind": "predictive"})
        with self.assertRaisesRegex(limpid.RequestError, "coupling.alpha: no such key"):
            loop.set({"coupling.k_vc": 3, "coupling.alpha": 1})
        with self.assertRaisesRegex(limpid.RequestError, r"coupling\.eta.*0\.01.*100"):
            loop.set({"coupling.k_vc": 3, "coupling.eta": -1})
        self.assertEqual(loop.get("coupling.eta", "coupling.kind", "coupling.k_vc"),
                         {"coupling.eta": 0.5, "coupling.kind": "predictive", "coupling.k_vc": 10})
        self.wait("the loop to have it", lambda: loop.row(["coupling/eta"])["coupling/eta"] == 0.5)

    def test_nobody_raises_a_limit(self) -> None:
        loop = self.connect()
        for values in ({"device.torque_limit": 1000}, {"ledger.energy": 0.02}, {"tank.energy": 0.02}, {"tank.most": 1}):
            with self.assertRaisesRegex(limpid.RequestError, "only a person|Only a person"):
                loop.set(values)
        loop.set({"device.torque_limit": 0.1})
        loop.set({"device.torque_limit": 0.2})  # below a person's limit
        with self.assertRaisesRegex(limpid.RequestError, "Only a person"):
            loop.twin({"ledger.energy": 0.02})

    def test_the_tick_stays_as_it_is(self) -> None:
        with self.assertRaisesRegex(limpid.RequestError, "loop.tick: cannot change"):
            self.connect().set({"loop.tick": 0.002})

    def test_errors_name_the_key_what_was_found_and_what_is_allowed(self) -> None:
        connection = self.raw()
        for text, said in (
            ("what", "one JSON object"),
            ("[1]", "one JSON object"),
            ('{"id": 1}', "do: is missing; allowed: hello, get"),
            ('{"do": "jump"}', 'do: "jump" is not known; allowed: hello'),
            ('{"do": "set", "valeus": {}}', 'set: "valeus" is not a key of this command; allowed: values, twin'),
            ('{"do": "set", "values": 3}', "set: values: 3 is not allowed"),
            ('{"do": "set", "values": {"coupling.eta": [1]}}', "coupling.eta: [1] is not allowed"),
            ('{"do": "follow", "channels": ["no"]}', 'channels: "no" is no channel'),
            ('{"do": "follow", "channels": ["hand/torqe"]}', "did you mean hand/torque?"),
            ('{"do": "follow", "channels": ["coupling/eta"], "rate": 1e9}', "allowed: 0.1 to 1000"),
            ('{"do": "mark", "text": ""}', "mark: text: 0 bytes in UTF-8; allowed: 1 to 200"),
            ('{"do": "open"}', "nothing to open; allowed: scene, arm, session, hand"),
            ('{"do": "open", "scene": "nowhere.toml"}', "allowed: a path that begins with /, or one of"),
            ('{"do": "record", "file": "here.h5"}', "allowed: a path that begins with / and ends in .h5"),
            ('{"do": "stop"}', "nothing is being recorded"),
            ('{"do": "ask", "text": "?"}', "needs a window"),
            ('{"id": [1], "do": "hello"}', "id: [1] is not allowed"),
            ("[" * 5000, "deep"),
        ):
            answer = self.say(connection, text)
            self.assertIn(said, answer.get("error", ""), text)

    def test_a_recording_has_every_tick_and_what_was_changed(self) -> None:
        loop = self.connect()
        file = loop.record(self.home / "a.h5")
        time.sleep(0.3)
        loop.set({"coupling.eta": 0.7})
        time.sleep(0.3)
        done = loop.stop()
        self.assertEqual((done["file"], done["dropped"]), (file, 0))
        session = limpid.session(file)
        self.assertEqual(len(session), done["rows"])
        self.assertGreater(len(session), 400)
        numpy.testing.assert_allclose(numpy.diff(session.time), session.tick)
        self.assertEqual([text for _, text in session.changes], ["coupling.eta = 0.7"])
        self.assertEqual(session.channel("coupling/eta")[-1], 0.7)
        with self.assertRaisesRegex(limpid.RequestError, "a.h5"):
            loop.record(file)  # the file exists

    def test_a_mark_is_kept_at_its_tick_while_something_is_recorded(self) -> None:
        loop = self.connect()
        loop.mark("nobody records")
        file = loop.record(self.home / "marked.h5")
        time.sleep(0.3)
        loop.mark("first \u03b7")
        time.sleep(0.2)
        loop.mark("second")
        with self.assertRaisesRegex(limpid.RequestError, "mark: text: 201 bytes in UTF-8; allowed: 1 to 200"):
            loop.mark("x" * 201)
        loop.stop()
        session = limpid.session(file)
        self.assertEqual([text for _, text in session.marks], ["first \u03b7", "second"])
        times = [at for at, _ in session.marks]
        self.assertGreater(times[0], 0.2)
        self.assertGreater(times[1], times[0] + 0.15)
        self.assertLessEqual(times[1], session.time[-1])  # the end may come within its tick

    def test_a_recording_that_ends_by_itself_is_said_at_once_to_everybody(self) -> None:
        writes, listens = self.connect(), self.connect()
        out = self.home / "full.h5"
        self.assertIsNone(writes.state()["trouble"])
        # A limit of file size stands for a full disk.
        resource.prlimit(self.process.pid, resource.RLIMIT_FSIZE, (1 << 20, resource.RLIM_INFINITY))
        writes.record(out)
        for client in (writes, listens):
            with self.assertRaisesRegex(limpid.RecordingError, "File too large.*limpid recover"):
                self.wait("the end of the recording", lambda: client.mark("once more") < 0)
        state = listens.state()
        self.assertFalse(state["recording"])
        self.assertIn("File too large", state["trouble"])
        resource.prlimit(self.process.pid, resource.RLIMIT_FSIZE,
                         (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
        writes.record(self.home / "next.h5")
        self.assertIsNone(writes.state()["trouble"])
        self.assertGreater(writes.stop()["rows"], 0)

    def test_a_hand_waits_for_the_recording_and_is_led_from_its_first_point(self) -> None:
        hand = limpid.runs.write_hand(PATH, self.home / "hand.csv")
        loop = self.connect()
        for turn in range(2):
            loop.open(hand=hand, wait=True)
            time.sleep(0.1)
            file = loop.record(self.home / f"{turn}.h5")
            time.sleep(1.2)
            loop.stop()
            again = limpid.run(hand=hand)
            session = limpid.session(file)
            rows = min(len(session), len(again))
            numpy.testing.assert_array_equal(session["hand/target"][:rows], again["hand/target"][:rows])
            self.assertGreater(len(session.contacts), 0)

    def test_a_live_recording_runs_again_bit_for_bit(self) -> None:
        hand = limpid.runs.write_hand(PATH, self.home / "hand.csv")
        loop = self.connect()
        loop.open(hand=hand)
        file = loop.record(self.home / "live.h5")
        time.sleep(0.4)
        loop.set({"coupling.kind": "predictive"})
        time.sleep(0.4)
        loop.stop()
        again = limpid.run(hand=file)
        session = limpid.session(file)
        for name in ("device/position", "proxy/position", "energy/controller_total"):
            numpy.testing.assert_array_equal(session[name], again[name])

    def test_rows_that_are_followed_carry_their_ticks(self) -> None:
        loop = self.connect()
        self.assertEqual(loop.follow(["coupling/eta", "hand/torque_norm"], rate=200), ["-", "N m"])
        rows = loop.rows(seconds=1)
        self.assertGreater(len(rows.ticks), 50)
        self.assertEqual({b - a for a, b in zip(rows.ticks, rows.ticks[1:])}, {5})
        self.assertEqual(rows.dropped, 0)
        self.assertTrue(all(len(row) == 2 for row in rows.values))
        loop.follow([])
        loop.rows(seconds=0.1)
        self.assertEqual(loop.rows(seconds=0.2).ticks, [])

    def test_scenes_arms_sessions_are_opened(self) -> None:
        loop = self.connect()
        self.assertEqual(loop.open(scene="spheres.toml")["scene"], "Soft and hard")
        state = loop.open(session=ASSETS / "sessions/table.h5")
        self.assertIn("table.h5", state["hand"]["source"])
        self.assertEqual(loop.open(arm="inverse3.urdf")["hand"], None)
        with self.assertRaisesRegex(limpid.RequestError, "no_such.urdf"):
            loop.open(arm=self.home / "no_such.urdf")
        loop.open(hand="touch.csv")

    def test_a_session_does_not_take_the_computer(self) -> None:
        fast = self.home / "fast.h5"
        done = subprocess.run([LIMPID, "run", "--set", "loop.tick=1e-5", "--duration", "0.001",
                               "--record", fast], capture_output=True, text=True, check=False)
        self.assertTrue(fast.exists(), done.stderr)
        loop = self.connect()
        with self.assertRaisesRegex(limpid.RequestError, r"tick of 1e-05 s.*0\.0001 to 0\.1"):
            loop.open(session=fast)
        self.assertEqual(loop.get("loop.tick"), {"loop.tick": 0.001})
        with self.assertRaisesRegex(limpid.RequestError, r"open: hand: a tick of 1e-05 s"):
            loop.open(hand=fast, arm="omni.urdf")
        with self.assertRaisesRegex(limpid.ProgramError, r"--hand .*tick of 1e-05 s.*loop\.tick=0\.001 replaces"):
            limpid.serve(hand=fast)
        for tick in (0.001, 1e-5):
            with limpid.serve(hand=fast, loop__tick=tick) as own:
                self.assertEqual(own.get("loop.tick"), {"loop.tick": tick})

    def test_start_over_begins_the_hand_again(self) -> None:
        loop = self.connect()
        loop.open(hand="touch.csv")
        time.sleep(0.5)
        before = loop.state()["hand"]["time"]
        loop.start_over()
        time.sleep(0.1)
        self.assertLess(loop.state()["hand"]["time"], before)

    def test_a_twin_runs_beside_under_its_own_settings(self) -> None:
        loop = self.connect()
        loop.open(hand="touch.csv")
        loop.twin({"coupling.kind": "standard"})
        names = ["coupling/kind", "twin/coupling/kind"]
        self.wait("the twin", lambda: self.twin_row(loop, names) == [1, 0])
        file = loop.record(self.home / "twin.h5")
        time.sleep(0.2)
        loop.stop()
        session = limpid.session(file)
        self.assertGreater(len(session), 100)
        self.assertEqual((session.law, session.twin.law), ("proposed", "standard"))

    def test_a_third_run_comes_and_goes_beside_the_second(self) -> None:
        loop = self.connect()
        loop.open(hand="touch.csv")
        with self.assertRaisesRegex(limpid.RequestError, "lane"):
            loop.twin(lane=2)
        loop.twin({"coupling.kind": "standard"})
        loop.twin({"coupling.kind": "predictive"}, lane=2)
        names = ["coupling/kind", "twin/coupling/kind", "lane3/coupling/kind"]
        self.wait("three runs", lambda: self.twin_row(loop, names) == [1, 0, 2])
        loop.set({"coupling.eta": 0.5}, lane=2)
        file = loop.record(self.home / "three.h5")
        time.sleep(0.2)
        loop.stop()
        session = limpid.session(file)
        self.assertEqual([run.law for run in session.lanes], ["proposed", "standard", "predictive"])
        self.assertEqual(set(session["lane3/coupling/eta"]), {0.5})
        self.assertEqual(session.lanes[2].channels, session.twin.channels)
        loop.twin(on=False, lane=2)
        self.wait("two runs", lambda: self.twin_row(loop, names) is None)
        self.assertEqual(loop.state()["lanes"], 2)

    @staticmethod
    def twin_row(loop, names):
        try:
            row = loop.row(names)
            return [row[name] for name in names]
        except limpid.RequestError:
            return None

    def test_cut_takes_the_force_away_and_start_over_gives_it_back(self) -> None:
        loop = self.connect()
        self.wait("force", lambda: loop.state()["force"])
        loop.cut()
        self.wait("no force", lambda: not loop.state()["force"])
        loop.start_over()
        self.wait("force", lambda: loop.state()["force"])

    def test_cut_is_taken_from_one_that_hangs_up_at_once(self) -> None:
        loop = self.connect()
        connection = self.raw()
        connection.sendall(b'{"do":"cut"}\n')
        connection.close()
        self.wait("no force", lambda: not loop.state()["force"])

    def test_a_picture_is_drawn_without_a_window(self) -> None:
        file = self.connect().picture(self.home / "a.png")
        self.assertEqual(Path(file).read_bytes()[:4], b"\x89PNG")

    def test_a_picture_replaces_no_file_unless_that_is_asked_for(self) -> None:
        loop = self.connect()
        file = self.home / "mine.png"
        file.write_text("mine")
        with self.assertRaisesRegex(limpid.RequestError, "picture: file: .*mine.png.* exists already; .*replace=True"):
            loop.picture(file)
        self.assertEqual(file.read_text(), "mine")
        loop.picture(file, replace=True)
        self.assertEqual(file.read_bytes()[:4], b"\x89PNG")

    def test_bye_ends_the_connection_and_others_go_on(self) -> None:
        other = self.connect()
        connection = self.raw()
        self.assertEqual(self.say(connection, '{"id": 7, "do": "bye"}'), {"id": 7, "ok": {}})
        self.assertEqual(connection.recv(1), b"")
        other.get("coupling.eta")

    def test_a_name_is_one_programs_at_a_time_and_that_is_said(self) -> None:
        second = subprocess.run([LIMPID, "serve"], env=self.environment, capture_output=True,
                                text=True, timeout=60)
        self.assertEqual(second.returncode, 2)
        self.assertIn(f"process {self.process.pid} (limpid serve", second.stderr)
        self.connect().get("coupling.eta")

    def test_what_a_killed_program_left_is_taken_over(self) -> None:
        self.process.kill()
        self.process.wait()
        self.assertTrue(self.socket.exists())
        self.process.communicate()
        self.start()
        self.connect().get("coupling.eta")

    def test_the_socket_goes_with_the_program_and_a_recording_is_complete(self) -> None:
        loop = self.connect()
        loop.record(self.home / "a.h5")
        time.sleep(0.2)
        self.end()
        self.assertFalse(self.socket.exists())
        self.assertEqual(self.process.returncode, 0)
        self.assertGreater(len(limpid.session(self.home / "a.h5")), 50)

    def test_bad_names_and_a_missing_folder_are_refused(self) -> None:
        for name in ("a/b", "", "ü", "x" * 65, "../x"):
            done = subprocess.run([LIMPID, "serve", name], env=self.environment,
                                  capture_output=True, text=True, timeout=60)
            self.assertEqual(done.returncode, 2, name)
        without = {k: v for k, v in self.environment.items() if k != "XDG_RUNTIME_DIR"}
        done = subprocess.run([LIMPID, "serve", "x"], env=without, capture_output=True, text=True,
                              timeout=60)
        self.assertIn("XDG_RUNTIME_DIR is not set", done.stderr)

    def test_a_folder_that_others_can_enter_is_closed_to_them(self) -> None:
        self.end()
        self.socket.parent.chmod(0o755)
        self.start()
        self.assertEqual(self.mode(self.socket.parent), 0o700)


class TestBadClients(RemoteTest):
    """Whatever clients do, the loop's ticks go on, and others are served."""

    def ticks_go_on(self, what: str, good) -> None:
        """The loop's ticks go on and a good client is answered. Punctuality depends on the
        computer; completeness does not."""
        before = good.state()
        good.follow(["coupling/eta"], rate=1000)
        rows = good.rows(seconds=1)
        good.follow([])
        good.rows(seconds=0.2)
        after = good.state()
        self.assertGreater(after["ticks"], before["ticks"] + 200, what)
        self.assertEqual({b - a for a, b in zip(rows.ticks, rows.ticks[1:])}, {1}, what)
        self.assertEqual(rows.dropped, 0, what)

    def test_one_that_floods(self) -> None:
        good = self.connect()
        stop = threading.Event()

        def flood() -> None:
            connection = self.raw()
            connection.settimeout(0.5)
            while not stop.is_set():
                try:
                    connection.sendall(b'{"do":"row"}\n' * 100 + b"rubbish\n" * 100)
                except OSError:
                    pass

        flooding = threading.Thread(target=flood)
        flooding.start()
        try:
            self.ticks_go_on("a flood", good)
        finally:
            stop.set()
            flooding.join()

    def test_a_line_of_a_megabyte(self) -> None:
        good = self.connect()
        connection = self.raw()
        try:
            connection.sendall(b"x" * (1 << 20))
        except OSError:
            pass  # it has hung up already
        self.assertIn("at most 65536 bytes", json.loads(self.line(connection))["error"])
        self.ticks_go_on("a long line", good)

    def test_a_line_as_long_as_is_allowed(self) -> None:
        start = '{"do": "mark", "text": "'
        text = start + "x" * (65536 - len(start) - 2) + '"}'
        self.assertIn("mark: text", self.say(self.raw(), text)["error"])

    def test_one_that_never_reads(self) -> None:
        good = self.connect()
        connection = self.raw()
        channels = ", ".join(f'"contact/force.{i}"' for i in range(1, 13))
        connection.sendall(f'{{"do": "follow", "channels": [{channels}], "rate": 1000}}\n'.encode())
        for _ in range(20):
            connection.sendall(b'{"do": "row"}\n')
        self.ticks_go_on("nobody reads", good)
        time.sleep(3)
        self.ticks_go_on("nobody reads for long", good)
        connection.setblocking(True)
        received, dropped = b"", 0
        while dropped == 0:
            received += connection.recv(1 << 16)
            *lines, received = received.split(b"\n")
            for line in lines:
                dropped = max(dropped, json.loads(line).get("dropped", 0))
        self.assertGreater(dropped, 0)

    def test_one_that_says_half_a_line_and_waits_for_ever(self) -> None:
        good = self.connect()
        self.raw().sendall(b'{"do": "hel')
        self.ticks_go_on("half a line", good)

    def test_ones_that_are_stopped_and_killed(self) -> None:
        good = self.connect()
        script = ("import limpid, time\n"
                  "loop = limpid.connect()\n"
                  "loop.follow(['coupling/eta'], rate=1000)\n"
                  "print('there', flush=True)\n"
                  "while True: loop.rows(1)\n")
        environment = {**os.environ, "PYTHONPATH": str(ASSETS / "python")}
        for how in (signal.SIGSTOP, signal.SIGKILL):
            client = subprocess.Popen([sys.executable, "-c", script], env=environment,
                                      stdout=subprocess.PIPE, text=True)
            self.addCleanup(client.communicate)
            self.addCleanup(client.kill)
            self.assertEqual(client.stdout.readline(), "there\n")
            client.send_signal(how)
            self.ticks_go_on(how.name, good)

    def test_more_than_there_is_room_for(self) -> None:
        good = self.connect()
        waiting = [self.raw() for _ in range(15)]
        for connection in waiting:
            self.assertIn("ok", self.say(connection, '{"do": "get", "keys": []}'))
        self.assertIn("16 programs are connected", json.loads(self.line(self.raw()))["error"])
        self.ticks_go_on("sixteen", good)
        waiting.pop().close()
        self.wait("room for another", lambda: self.is_let_in())

    def is_let_in(self) -> bool:
        connection = self.raw()
        try:
            return "ok" in self.say(connection, '{"do": "get", "keys": []}')
        except (OSError, json.JSONDecodeError):
            return False
        finally:
            connection.close()

    def test_ones_that_come_and_go(self) -> None:
        good = self.connect()
        for _ in range(300):
            connection = self.raw()
            connection.sendall(b'{"do": "open", "scene": "spheres.toml"}\n')
            connection.close()
        self.ticks_go_on("comings and goings", good)


class TestPackage(RemoteTest):
    def test_serve_ends_with_its_client(self) -> None:
        with limpid.serve(scene=ASSETS / "scenes/spheres.toml", settings={"coupling.eta": 0.8}) as loop:
            self.assertEqual(loop.get("coupling.eta"), {"coupling.eta": 0.8})
            process = loop._process
        self.assertEqual(process.returncode, 0)

    def test_serve_ends_with_a_python_that_is_killed(self) -> None:
        script = ("import limpid, time\n"
                  "loop = limpid.serve()\n"
                  "print(loop._process.pid, flush=True)\n"
                  "time.sleep(100)\n")
        python = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True,
                                  env={**os.environ, "PYTHONPATH": str(ASSETS / "python")})
        served = int(python.stdout.readline())
        python.kill()
        python.communicate()
        self.wait("the program to end", lambda: not self.runs(served))

    @staticmethod
    def runs(process: int) -> bool:
        try:
            return Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
        except FileNotFoundError:
            return False

    def test_serve_says_what_the_program_refuses(self) -> None:
        with self.assertRaisesRegex(limpid.ProgramError, "nowhere.toml"):
            limpid.serve(scene=self.home / "nowhere.toml")

    def test_nobody_listens(self) -> None:
        with self.assertRaisesRegex(limpid.ProgramError, "start `limpid --listen`"):
            limpid.connect("nobody")

    def test_run_gives_what_limpid_run_does(self) -> None:
        hand = limpid.runs.write_hand(PATH, self.home / "hand.csv")
        out = self.home / "run.h5"
        subprocess.run([LIMPID, "run", "--hand", hand, "--coupling", "predictive", "--eta", "0.5",
                        "--set", "coupling.k_vc=8", "--record", out], check=True,
                       stdout=subprocess.DEVNULL)
        session = limpid.run(hand=numpy.array(PATH), coupling="predictive", eta=0.5, coupling__k_vc=8)
        with h5py.File(out) as file:
            for name in ("device/position", "proxy/tip", "contact/total_force"):
                numpy.testing.assert_array_equal(session[name], file[name][()])
                self.assertEqual(session.unit(name), file[name].attrs["unit"])
        self.assertEqual(session.law, "predictive")
        [contact] = session.contacts
        self.assertLess(0.2, contact.begins)
        self.assertAlmostEqual(contact.point[2], -0.04, places=2)
        self.assertGreater(contact.force, 0.1)

    def test_a_hand_is_rows_wherever_one_is_asked_for(self) -> None:
        session = limpid.run(hand=PATH, duration=0.1)
        self.assertRegex(session.attributes["source"], r"^\d+ rows from Python, SHA-256 [0-9a-f]{8}$")
        loop = self.connect()
        self.assertEqual(loop.open(hand=numpy.array(PATH))["hand"]["source"], session.attributes["source"])
        with limpid.serve(hand=iter(PATH)) as served:
            self.assertEqual(served.state()["hand"]["source"], session.attributes["source"])

    def test_settings_are_spelt_alike_wherever_they_are(self) -> None:
        law = limpid.run(duration=0.05, settings={"coupling.eta": 0.7}, coupling__k_vc=8, coupling="standard").config
        self.assertIn("0.7", law)
        loop = self.connect()
        loop.set({"coupling.eta": 0.7}, coupling__k_vc=8, coupling="standard")
        self.assertEqual(loop.get("coupling.eta", "coupling.k_vc", "coupling.kind"),
                         {"coupling.eta": 0.7, "coupling.k_vc": 8, "coupling.kind": "standard"})
        loop.set(reset=True, eta=numpy.float32(0.5))
        self.assertEqual(loop.get("coupling.eta", "coupling.k_vc", "coupling.kind"),
                         {"coupling.eta": 0.5, "coupling.k_vc": 10, "coupling.kind": "proposed"})
        for wrong in (float("nan"), None, [1]):
            with self.assertRaises(limpid.ArgumentError):
                loop.set({"coupling.eta": wrong})

    def test_a_file_that_is_there_is_replaced_only_by_force(self) -> None:
        out = self.home / "a.h5"
        limpid.run(duration=0.05, record=out)
        with self.assertRaisesRegex(limpid.ProgramError, "force=True"):
            limpid.run(duration=0.05, record=out)
        self.assertEqual(len(limpid.run(duration=0.1, record=out, force=True)), 100)
        loop = self.connect()
        with self.assertRaisesRegex(limpid.RequestError, "exists; force=True overwrites it"):
            loop.record(out)
        loop.record(out, force=True)
        loop.stop()

    def test_a_connection_that_is_closed_says_so(self) -> None:
        loop = self.connect()
        loop.close()
        for call in (loop.state, loop.rows, loop.stop):
            with self.assertRaisesRegex(limpid.ProgramError, "closed"):
                call()

    def test_a_variation_is_another_hand(self) -> None:
        hands = [limpid.run(duration=0.5, **how)["hand/target"] for how in (
            {}, {"variation": 1}, {"variation": 1, "seed": 1}, {"variation": 2}, {"variation": 1})]
        self.assertEqual(len({hand.tobytes() for hand in hands}), 4)
        numpy.testing.assert_array_equal(hands[1], hands[4])

    def test_run_says_what_is_refused(self) -> None:
        with self.assertRaisesRegex(limpid.ProgramError, "coupling.eta"):
            limpid.run(eta=-1)
        with self.assertRaisesRegex(limpid.LimpidError, "at least two rows"):
            limpid.run(hand=[(0, 0, 0, 0)])

    def test_a_sweep_is_all_points_of_its_axes(self) -> None:
        found = [(point, session.law, session["coupling/eta"][0]) for point, session in
                 limpid.sweep({"coupling": ["standard", "proposed"], "eta": [0.7, 1]}, duration=0.05)]
        self.assertEqual([(point["coupling"], point["eta"]) for point, _, _ in found],
                         [(law, eta) for _, law, eta in found])
        self.assertEqual(len(found), 4)

    def test_the_demo_runs(self) -> None:
        done = subprocess.run([sys.executable, "-m", "limpid", "demo"], check=True, text=True,
                              capture_output=True,
                              env={**os.environ, "PYTHONPATH": str(ASSETS / "python")}, timeout=120)
        self.assertIn("predictive  coordination/error", done.stdout)
        self.assertIn(", 0 missing", done.stdout)

    def test_sessions_name_what_is_wrong(self) -> None:
        session = limpid.run(duration=0.05)
        with self.assertRaisesRegex(limpid.LimpidError, "no/such is no channel; there are contact/force"):
            session.channel("no/such")
        (self.home / "no.h5").write_text("no")
        with self.assertRaisesRegex(limpid.LimpidError, "no.h5: cannot be read"):
            limpid.session(self.home / "no.h5")


if __name__ == "__main__":
    unittest.main()
