"""Film materials of one's own, in the program's solver."""

import unittest

import numpy as np

import hydrodip
from common import QUICK, textured_cone

SPHERE = dict(film=(110, 110), film_elements=10000, dip_step_mm=0.1, dip_air_cells=0, size=60, depth=8,
              material_tear_stretch=0)


def papers(poisson):
    """Eq. 3 of the paper for Young's modulus 1, by the inverse stretches."""
    mu, lam = 1 / (2 * (1 + poisson)), poisson / ((1 + poisson) * (1 - 2 * poisson))
    return lambda a, b: mu * ((a - 1) ** 2 + (b - 1) ** 2) + lam / 2 * (a + b - 2) ** 2


def rubber(s, t):
    """Neo-Hookean in the plane, per mm^2 of flat film."""
    j = np.log(s * t)
    return 0.25 * (s**2 + t**2 - 2 - 2 * j) + 0.2 * j**2


class Materials(unittest.TestCase):
    def test_the_papers_material_as_a_table_makes_the_same_film(self):
        sphere = hydrodip.Mesh.sample("sphere")
        for poisson in (0.0, 0.3):
            built_in = hydrodip.simulate(sphere, **SPHERE, material_poisson=poisson).film.positions
            energy = papers(poisson)
            by_stretch = lambda s, t: s * t * energy(1 / s, 1 / t)
            for material in (
                hydrodip.Material.paper(poisson),
                hydrodip.Material(energy, of="shrink"),
                hydrodip.Material(by_stretch),
            ):
                again = hydrodip.simulate(sphere, **SPHERE, material=material).film.positions
                apart = np.linalg.norm(again - built_in, axis=1).max()
                print(f"\npoisson {poisson}: {apart:.1e} mm apart")
                self.assertLess(apart, 1e-4)

    def test_another_material_makes_another_film(self):
        sphere = hydrodip.Mesh.sample("sphere")
        built_in = hydrodip.simulate(sphere, **SPHERE)
        other = hydrodip.simulate(sphere, **SPHERE, material=hydrodip.Material(rubber))
        self.assertEqual(other.statistics.failed_steps, 0)
        self.assertGreater(np.abs(other.film.positions - built_in.film.positions).max(), 0.005)
        # Round about the axis it is as even as the sphere and the film's grid are.
        flipped = other.film.positions * [-1, 1, 1]
        by_place = {tuple(np.round(u, 6)): p for u, p in zip(other.film.film_coordinates, flipped)}
        for u, p in zip(other.film.film_coordinates, other.film.positions):
            mirrored = by_place[(round(-u[0], 6) + 0.0, round(u[1], 6))]
            self.assertLess(np.abs(p - mirrored).max(), 0.02)

    def test_a_table_of_numbers_is_the_function_that_made_it(self):
        side = np.linspace(0.4, 2.5, 129)
        s, t = np.meshgrid(side, side, indexing="ij")
        made = hydrodip.Material(rubber(s, t))
        by_function = hydrodip.Material(rubber)
        at = np.array([[1.0, 1.0], [0.8, 1.1], [1.3, 0.7]])
        np.testing.assert_allclose(made.values_at(at), by_function.values_at(at), atol=2e-4)
        a, b = at.T
        np.testing.assert_allclose(made.values_at(at)[:, 0], a * b * rubber(1 / a, 1 / b), atol=1e-6)

    def test_derivatives_are_those_of_the_energy(self):
        material = hydrodip.Material(rubber)
        h = 1e-4
        at = np.array([[0.8, 1.1], [1.3, 0.7], [1.0, 1.0]])
        value = lambda da, db: material.values_at(at + [da, db])
        exact = value(0, 0)
        np.testing.assert_allclose((value(h, 0) - value(-h, 0))[:, 0] / (2 * h), exact[:, 1], atol=1e-6)
        np.testing.assert_allclose((value(0, h) - value(0, -h))[:, 0] / (2 * h), exact[:, 2], atol=1e-6)
        np.testing.assert_allclose((value(0, h) - value(0, -h))[:, 1] / (2 * h), exact[:, 4], atol=1e-4)

    def test_what_is_no_material_is_refused(self):
        for bad in (
            lambda s, t: s + 2 * t,
            lambda s, t: np.log(s - 1),
        ):
            with self.assertRaises(hydrodip.InputError), np.errstate(all="ignore"):
                hydrodip.Material(bad)
        with self.assertRaises(hydrodip.InputError):
            hydrodip.Material(rubber, of="strain")
        with self.assertRaises(hydrodip.InputError):
            hydrodip.Material(np.zeros((4, 4)))

    def test_design_and_orient_take_it_too(self):
        made = hydrodip.design(textured_cone(), **QUICK, dpi=72, material=hydrodip.Material(rubber))
        self.assertTrue(made.settled)
        plain = hydrodip.design(textured_cone(), **QUICK, dpi=72)
        self.assertGreater(np.abs(made.film.positions - plain.film.positions).max(), 1e-3)


if __name__ == "__main__":
    unittest.main()
