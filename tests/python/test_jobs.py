"""The module and the command line say the same, to the bit."""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import textwrap
import unittest
import unittest.mock

import numpy as np

import hydrodip
from common import QUICK, QUICK_OPTIONS, InFolder, run, textured_cone

DESIGN = dict(QUICK, dpi=72, print_samples=1)
DESIGN_OPTIONS = QUICK_OPTIONS + "--dpi 72 --set print.samples=1".split()


def write_stl(name, corners):
    rows = np.zeros(len(corners), np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")]))
    rows["corners"] = corners
    with open(name, "wb") as file:
        file.write(bytes(80) + np.uint32(len(rows)).tobytes() + rows.tobytes())


def read(*path):
    with open(os.path.join(*path), "rb") as file:
        return file.read()


class SameAsTheCommandLine(InFolder):
    def setUp(self):
        super().setUp()
        run("sample", "sphere", "-o", ".")
        self.pose = dict(size=40, depth=8)
        self.pose_options = ["--size", "40", "--depth", "8"]

    def test_simulate(self):
        run("simulate", "sphere.obj", *self.pose_options, *QUICK_OPTIONS, "-o", "there")
        dip = hydrodip.simulate("sphere.obj", **self.pose, **QUICK)
        dip.film.write("film.ply")
        self.assertEqual(read("film.ply"), read("there", "film.ply"))
        report = json.loads(read("there", "report.json"))
        for figure in ("covered_mm2", "covered_share", "doubtful_mm2", "covered_downward_mm2", "covered_downward_share"):
            self.assertEqual(getattr(dip.coverage, figure), report["coverage"][figure], figure)

    def test_design_and_what_its_print_leaves(self):
        run("print", "sphere.obj", *self.pose_options, *DESIGN_OPTIONS, "-o", "there")
        made = hydrodip.design("sphere.obj", **self.pose, **DESIGN)
        made.film.write("film.ply")
        made.write_sheet("here")
        self.assertEqual(read("film.ply"), read("there", "film.ply"))
        for name in ("print.png", "print.tif", "print.pdf"):
            self.assertEqual(read("here", name), read("there", name), name)
        np.testing.assert_array_equal(made.print_image, hydrodip._core.read_image("there/print.png"))

    def test_a_printed_picture_dipped_as_file_and_as_array(self):
        rows, columns = 227, 283
        picture = np.zeros((rows, columns, 4), np.uint8)
        picture[80:150, 90:200] = (20, 20, 20, 255)
        from hydrodip import _core

        _core.write_png("printed.png", picture)
        run("simulate", "sphere.obj", *self.pose_options, *QUICK_OPTIONS, "--film-image", "printed.png",
            "-o", "there")
        for given in ("printed.png", picture):
            dip = hydrodip.simulate("sphere.obj", film_image=given, **self.pose, **QUICK)
            dip.film.write("again.ply")
            self.assertEqual(read("again.ply"), read("there", "film.ply"))
        blank = hydrodip.simulate("sphere.obj", **self.pose, **QUICK)
        self.assertGreater(np.abs(blank.film.positions - dip.film.positions).max(), 0.01)

    def test_a_mesh_in_memory_is_what_its_file_is(self):
        mesh = hydrodip.Mesh.load("sphere.obj")
        from_file = hydrodip.simulate("sphere.obj", **self.pose, **QUICK)
        for same in (mesh, hydrodip.Mesh(mesh.vertices, mesh.faces)):
            dip = hydrodip.simulate(same, **self.pose, **QUICK)
            np.testing.assert_array_equal(dip.film.positions, from_file.film.positions)

    def test_a_job_file_is_a_job(self):
        with open("job.toml", "w") as job:
            job.write('[object]\nfile = "sphere.obj"\nsize_mm = 40\n[dip]\ndepth_mm = 8\n')
        dip = hydrodip.simulate("job.toml", **QUICK)
        by_hand = hydrodip.simulate("sphere.obj", **self.pose, **QUICK)
        np.testing.assert_array_equal(dip.film.positions, by_hand.film.positions)

    def test_orient(self):
        textured_cone().save("cone.ply")
        options = [*QUICK_OPTIONS, "--set", "film.elements=300", "--set", "dip.step_mm=4"]
        said = json.loads(run("orient", "cone.ply", *options, "--json", "--quiet", "-o", "o").stdout)
        found = hydrodip.orient("cone.ply", **dict(QUICK, film_elements=300, dip_step_mm=4.0))
        self.assertEqual(len(found.poses), len(said["poses"]))
        for ours, theirs in zip(found.poses, said["poses"]):
            self.assertEqual(list(ours.rotate_deg), theirs["rotate_deg"])
            self.assertEqual(ours.depth_mm, theirs["depth_mm"])
            self.assertEqual(ours.score, theirs["score"])
        self.assertNotIn("out", os.listdir("."))

    def test_plan_and_print_of_several_dips(self):
        tables = [{"rotate_deg": [0, 0, 0], "depth_mm": 8}, {"rotate_deg": [180, 0, 0], "depth_mm": 8}]
        with open("job.toml", "w") as job:
            job.write('[object]\nfile = "sphere.obj"\nsize_mm = 40\n')
            for t in tables:
                job.write(f"[[dip]]\nrotate_deg = {t['rotate_deg']}\ndepth_mm = 8\nlocked = true\n")
        said = json.loads(run("plan", "job.toml", *QUICK_OPTIONS, "--json", "--quiet", "-o", "p").stdout)
        found = hydrodip.plan("sphere.obj", size=40, dip_tables=[dict(t, locked=True) for t in tables], **QUICK)
        self.assertEqual([d.covered_share for d in found.dips], [d["covered_share"] for d in said["dips"]])
        self.assertEqual([list(d.rotate_deg) for d in found.dips], [t["rotate_deg"] for t in tables])

    def test_a_plan_in_haste_makes_no_sheets_in_haste(self):
        hydrodip.plan("sphere.obj", size=40, film="120x120", dips=1, quality="draft", output="p")
        plan = read("p", "plan.toml").decode()
        self.assertIn("[[dip]]", plan)
        self.assertNotRegex(plan, "rounds_max|pictures|elements|step_mm")

    def test_scans(self):
        quick = dict(film="110x110", film_elements=1000, dip_step_mm=1.0)
        made = hydrodip.synth(["sphere"], output="scans", **quick)
        self.assertIn("sphere-scan.obj", made.files)
        said = json.loads(run("measure", "sphere=scans/sphere-scan.obj", "--film", "110x110", "--set",
                              "film.elements=1000", "--set", "dip.step_mm=1", "--json", "--quiet").stdout)
        found = hydrodip.measure({"sphere": "scans/sphere-scan.obj"}, **quick)
        self.assertEqual(found.scans[0].methods["full"].rms_mm,
                         said["scans"][0]["methods"]["full"]["rms_mm"])
        fit = hydrodip.calibrate({"sphere": "scans/sphere-scan.obj"}, z_stretch="0.6,0.7", ratio="600",
                                 poisson="0", output="fit", **quick)
        self.assertAlmostEqual(fit.parameters.z_stretch, 0.65, delta=0.05)
        self.assertEqual(fit.report, json.loads(read("fit", "calibration.json")))

    def test_profiles_are_kept_in_one_place_whatever_is_said_of_home(self):
        for said in ({"HOME": os.getcwd()}, {"HOME": "/elsewhere", "XDG_CONFIG_HOME": os.getcwd()}, {},
                     {"HOME": "relative", "XDG_CONFIG_HOME": "relative"}):
            with unittest.mock.patch.dict(os.environ, said):
                for name in {"HOME", "XDG_CONFIG_HOME"} - said.keys():
                    os.environ.pop(name, None)
                self.assertIn(hydrodip._jobs._profile_folder(), run("profile", "list", "--json").stdout.decode())

    def test_another_country_writes_the_same_profile(self):
        folder = tempfile.mkdtemp(dir=".")
        made = subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8", os.path.join(folder, "de_DE.UTF-8")],
                              capture_output=True) if shutil.which("localedef") else None
        if made is None or made.returncode != 0:
            self.skipTest("no German locale can be made")
        quick = dict(film="110x110", film_elements=1000, dip_step_mm=1.0)
        hydrodip.synth(["sphere"], output="scans", **quick)
        code = ("import locale, hydrodip; locale.setlocale(locale.LC_ALL, LANGUAGE); "
                "hydrodip.calibrate('sphere=scans/sphere-scan.obj', z_stretch='0.6,0.7', ratio='600', "
                f"poisson='0', output=OUTPUT, **{quick!r})")
        for language, output in (("C", "plain"), ("de_DE.UTF-8", "german")):
            subprocess.run([sys.executable, "-c", code.replace("LANGUAGE", repr(language)).replace("OUTPUT", repr(output))],
                           env=dict(os.environ, LOCPATH=os.path.abspath(folder)), check=True)
        self.assertEqual(read("german", "profile.toml"), read("plain", "profile.toml"))
        self.assertRegex(read("german", "profile.toml").decode(), "z_stretch = 0.[5-7]")


class Arguments(InFolder):
    def refused(self, pattern, **arguments):
        with self.assertRaisesRegex(hydrodip.InputError, pattern):
            hydrodip.simulate(textured_cone(), **{**QUICK, **arguments})

    def test_no_scan_is_no_calibration(self):
        with self.assertRaisesRegex(hydrodip.InputError, "no scan is given"):
            hydrodip.calibrate({})

    def test_values_are_checked_as_by_the_program(self):
        self.refused("film_elements: film.elements must be a whole number", film_elements=3.5)
        self.refused("dip_step_mm", dip_step_mm=-1)
        self.refused("object_down", object_down="sideways")
        self.refused("rotate", rotate=(1, 2))
        self.refused("rotate", rotate=("90", "0", "0"))
        self.refused("size", size={"mm": 40})
        self.refused("film.elemnts.*film.elements", settings={"film.elemnts": 3})
        self.refused("--film", film="a7")
        self.refused("", quality="superb")
        self.refused("not fit|wide|large", size=500)
        with self.assertRaises(TypeError):
            hydrodip.simulate(textured_cone(), elements=3)
        with self.assertRaises(TypeError):
            hydrodip.simulate(textured_cone(), depth=3, dip_depth_mm=4)

    def test_what_is_of_no_such_kind_is_told_what_it_should_be(self):
        for keyword, value in (
            ("artwork", "logo.png"), ("artwork", ["logo.png"]), ("artwork", {"image": "logo.png"}), ("artwork", 3),
            ("dip_tables", [3]), ("film", 3), ("film", (1, 2, 3)), ("profile", 3), ("config", [3]), ("config", {"film.elements": 800}), ("settings", ["film.elements"]), ("quality", 3), ("material", 3.5),
            ("progress", 3), ("output", 3), ("film_image", 3), ("film", ("100", "80")), ("film", {"width": 100}),
        ):
            with self.subTest(keyword, value=value), self.assertRaisesRegex(TypeError, f"^{keyword} is a .*, not "):
                hydrodip.print_job(textured_cone(), **{"output": "none", keyword: value})
        for keyword, value in (
            ("z_stretch", [0.6, 0.7]), ("ratio", 600), ("poisson", 0.1), ("board", 3), ("square_mm", "5"), ("scan_units", 3),
            ("aligned", "no"), ("mirrored", 2), ("shard", 3), ("torn_rings", 3), ("torn_rings", [1.5]), ("merge", 3), ("progress", 3), ("output", 3),
        ):
            with self.subTest(keyword, value=value), self.assertRaisesRegex(TypeError, f"^{keyword} is a .*, not "):
                hydrodip.calibrate({"sphere": "scan.obj"}, **{keyword: value})
        with self.assertRaisesRegex(TypeError, "^scans is a .*, not "):
            hydrodip.measure({"sphere": 3})
        for keyword, value in (("seed", 0.5), ("seed", -1), ("noise_mm", "1"), ("missing_share", [1])):
            with self.subTest(keyword, value=value), self.assertRaisesRegex(TypeError, f"^{keyword} is a .*, not "):
                hydrodip.synth(["sphere"], output="none", **{keyword: value})

    def test_no_file_and_no_colours_are_said(self):
        with self.assertRaisesRegex(hydrodip.InputError, "nowhere.obj"):
            hydrodip.simulate("nowhere.obj")
        with self.assertRaisesRegex(hydrodip.InputError, "^no model is named"):
            hydrodip.simulate(None)
        with self.assertRaisesRegex(hydrodip.InputError, "nothing to print"):
            bare = textured_cone()
            hydrodip.design(hydrodip.Mesh(bare.vertices, bare.faces), **DESIGN)

    def test_a_dip_that_cannot_be_computed(self):
        self.assertTrue(issubclass(hydrodip.DipError, RuntimeError))
        self.assertTrue(issubclass(hydrodip.InputError, ValueError))

    def test_numpy_values_and_settings_by_name(self):
        by_keyword = hydrodip.simulate(textured_cone(), **QUICK, rotate=np.array([0, 0, 30]))
        by_name = hydrodip.simulate(
            textured_cone(), **dict(QUICK, film_elements=None, dip_step_mm=np.float32(1)),
            settings={"film.elements": np.int64(800), "object.rotate_deg": "0,0,30"})
        np.testing.assert_array_equal(by_keyword.film.positions, by_name.film.positions)

    def test_a_way_in_as_rows(self):
        rows = np.array([[0, 0, 0, 0, 0, 0], [10, 5, 0, 0, 0, 0]], dtype=float)
        np.savetxt("way.csv", rows, delimiter=",", comments="",
                   header="lower_mm,shift_x_mm,shift_y_mm,turn_x_deg,turn_y_deg,turn_z_deg")
        dips = [hydrodip.simulate(textured_cone(), **QUICK, path=p) for p in (rows, "way.csv")]
        np.testing.assert_array_equal(dips[0].film.positions, dips[1].film.positions)
        straight = hydrodip.simulate(textured_cone(), **QUICK, depth=10)
        self.assertGreater(np.abs(straight.film.positions - dips[0].film.positions).max(), 1)

    def test_artwork(self):
        picture = np.zeros((8, 8, 3), np.uint8)
        picture[:, :4] = (255, 0, 0)
        from hydrodip import _core

        _core.write_png("art.png", picture)
        bare = hydrodip.Mesh(textured_cone().vertices, textured_cone().faces)
        made = hydrodip.design(bare, artwork=[{"image": "art.png", "size_mm": [20, 20]}], **DESIGN)
        self.assertGreater(made.film_image[..., 3].max(), 0)

    def test_artwork_as_the_documentation_puts_it_on(self):
        from hydrodip import _core

        page = (pathlib.Path(__file__).parents[2] / "docs" / "python.md").read_text()
        section = re.search(r"^## Artwork\n(.*?)^## ", page, re.S | re.M)[1]
        example = textwrap.dedent("\n".join(line for line in section.splitlines() if line.startswith("    ")))
        picture = np.zeros((8, 8, 3), np.uint8)
        picture[:, :4] = (255, 0, 0)
        _core.write_png("photo.png", picture)
        run("sample", "sphere", "-o", ".")
        sphere = hydrodip.Mesh.load("sphere.obj")
        write_stl("part.stl", sphere.vertices[sphere.faces] * 40 / np.ptp(sphere.vertices, axis=0).max())
        said = {"hydrodip": hydrodip}
        exec(example, said)
        inked = said["made"].film_image[said["made"].film_image[..., 3] > 0]
        self.assertGreater(len(inked), 0)
        self.assertTrue((inked[:, 0] > 200).any() and (inked[:, 0] < 60).any(), "both halves of the picture")
        self.assertEqual({"print.pdf", "print.png", "print.tif"} - set(os.listdir("sheet")), set())

    def test_every_parameter_is_a_keyword(self):
        import inspect

        names = set(inspect.signature(hydrodip.design).parameters)
        short = {"object_units", "object_size_mm", "object_down", "object_rotate_deg", "object_texture",
                 "dip_depth_mm", "dip_method", "plan_dips", "print_dpi", "ink_profile", "run_threads"}
        for p in hydrodip.parameters():
            if p.name.split(".")[0] not in ("process", "stage", "cost", "output", "report") and p.name != "object.file":
                self.assertIn(p.keyword, names | short)
                self.assertTrue(p.help)
        self.assertIn("default: 40000", hydrodip.simulate.__doc__)

    def test_version_is_the_programs(self):
        self.assertEqual(run("--version").stdout.decode().split()[:2], ["hydrodip", hydrodip.__version__])


if __name__ == "__main__":
    unittest.main()
