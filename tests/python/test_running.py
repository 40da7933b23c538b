"""Progress, interrupts, threads, memory, and the time that importing takes."""

import os
import signal
import subprocess
import sys
import threading
import time
import unittest

import numpy as np

import hydrodip
from common import QUICK, textured_cone

LONG = dict(film="a4", film_elements=160000, dip_step_mm=0.02, dip_air_cells=0)


def resident_kb():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") // 1024


class Running(unittest.TestCase):
    def test_progress_is_told(self):
        seen = []
        hydrodip.simulate(textured_cone(), **QUICK, progress=lambda what, share: seen.append((what, share)))
        self.assertIn("dipping", {what for what, _ in seen})
        self.assertTrue(all(0 <= share <= 1 for _, share in seen))
        dipping = [share for what, share in seen if what == "dipping"]
        self.assertEqual(dipping, sorted(dipping))

    def test_what_progress_raises_ends_the_work(self):
        class Enough(Exception):
            pass

        def progress(what, share):
            if what == "dipping":
                raise Enough

        with self.assertRaises(Enough):
            hydrodip.simulate(textured_cone(), **LONG, progress=progress)

    def interrupted(self):
        begun = threading.Event()
        sent, returned = [], []

        def send():
            begun.wait()
            time.sleep(0.1)
            sent.append(time.perf_counter())
            os.kill(os.getpid(), signal.SIGINT)

        sender = threading.Thread(target=send)
        sender.start()
        try:
            with self.assertRaises(KeyboardInterrupt):
                hydrodip.simulate(
                    textured_cone(), **LONG,
                    progress=lambda what, share: begun.set() if what == "dipping" else None)
                returned.append(True)
                time.sleep(10)  # were the interrupt late
            self.assertEqual(returned, [])
            return time.perf_counter() - sent[0]
        finally:
            begun.set()
            sender.join()

    def test_an_interrupt_ends_a_dip_in_its_middle(self):
        took = [self.interrupted() for _ in range(5)]
        print(f"\ninterrupted after {', '.join(f'{1000 * t:.0f}' for t in took)} ms")
        # and the module goes on working
        self.assertEqual(hydrodip.simulate(textured_cone(), **QUICK).statistics.failed_steps, 0)

    def test_other_threads_run_meanwhile(self):
        turns = []
        done = threading.Event()

        def count():
            while not done.is_set():
                turns.append(1)
                time.sleep(0.001)

        counter = threading.Thread(target=count)
        counter.start()
        before = len(turns)
        hydrodip.simulate(textured_cone(), **dict(QUICK, film_elements=20000, dip_step_mm=0.25))
        during = len(turns) - before
        done.set()
        counter.join()
        self.assertGreater(during, 10)

    def test_jobs_side_by_side_give_the_same(self):
        alone = hydrodip.simulate(textured_cone(), **QUICK).film.positions
        found = [None] * 4

        def work(k):
            found[k] = hydrodip.simulate(textured_cone(), **QUICK).film.positions

        threads = [threading.Thread(target=work, args=(k,)) for k in range(4)]
        for t in threads:
            t.start()
        for t in threads:
            t.join()
        for positions in found:
            np.testing.assert_array_equal(positions, alone)

    def test_a_thousand_dips_do_not_grow(self):
        mesh = textured_cone()
        quick = dict(QUICK, film_elements=200, dip_step_mm=3.0)

        def many(count):
            for _ in range(count):
                dip = hydrodip.simulate(mesh, **quick)
                dip.film.positions, dip.film.deformation_gradient, dip.frames, dip.vertices
                dip.to_object(np.zeros((1, 2)))
                with self.assertRaises(hydrodip.InputError):
                    hydrodip.simulate(mesh, **quick, depth=-1)
            return resident_kb()

        after_100 = many(100)
        after_1000 = many(900)
        print(f"\nresident after 100 dips {after_100} kB, after 1000 {after_1000} kB")
        self.assertLess(after_1000 - after_100, 2000)

    def test_importing_is_quick_and_needs_no_numpy(self):
        code = "import sys, hydrodip; print('numpy' in sys.modules, 'matplotlib' in sys.modules)"
        said = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
        self.assertEqual(said.stdout.split(), ["False", "False"])


if __name__ == "__main__":
    unittest.main()
