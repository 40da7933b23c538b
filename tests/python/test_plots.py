"""Pictures: what they show lies where it has to."""

import unittest

import matplotlib.pyplot as plt
import numpy as np

import hydrodip
from common import QUICK, textured_cone


class Plots(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.dip = hydrodip.simulate(textured_cone(), **QUICK)

    def tearDown(self):
        plt.close("all")

    def test_the_flat_film(self):
        for quantity in ("stretch", "least_stretch", "area_ratio", self.dip.film.stretch):
            ax = hydrodip.plot_film(self.dip, quantity)
            drawn = sum(len(part.get_paths()) for part in ax.collections)
            self.assertEqual(drawn, len(self.dip.film.triangles))
        self.assertEqual(ax.get_xlim(), (-40, 40))

    def picture(self, *arguments, **options):
        ax = hydrodip.plot_on_object(*arguments, colorbar=False, pixels=200, **options)
        (image,) = ax.images
        return image.get_array(), image.get_extent()

    def test_on_the_object_things_are_where_they_are(self):
        # From straight below, x to the right: where the ray meets the cone, film shows its own x.
        picture, (left, right, bottom, top) = self.picture(
            self.dip, lambda u: u[:, 0], azimuth_deg=-90, elevation_deg=-90, cmap="gray", vmin=-20, vmax=20)
        rows, columns = picture.shape[:2]
        self.assertAlmostEqual((right - left) / (top - bottom), columns / rows, delta=0.02)
        self.assertTrue((picture[0, 0, 3] == 0) and (picture[rows // 2, columns // 2, 3] == 1))
        tone = picture[rows // 2, :, 0]
        shown = tone[columns // 4 : 3 * columns // 4]
        self.assertGreater(abs(np.corrcoef(shown, np.arange(len(shown)))[0, 1]), 0.95)
        # All that is seen of the cone from there is a disc of its radius.
        disc = picture[..., 3].mean() * (right - left) * (top - bottom)
        self.assertAlmostEqual(disc, 24 / 2 * np.sin(2 * np.pi / 24) * 20**2, delta=30)

    def test_colours_of_the_object(self):
        made = hydrodip.design(textured_cone(), **QUICK, dpi=72, ink_rounds_max=1)
        pictures = [self.picture(made, q, azimuth_deg=-90, elevation_deg=-90)[0] for q in ("predicted", "wanted")]
        for picture in pictures:
            colors = picture[picture[..., 3] > 0][:, :3]
            self.assertGreater(np.ptp(colors, axis=0).min(), 0.2)
        middle = (slice(60, 140), slice(60, 140))
        apart = np.abs(pictures[0][middle][..., :3] - pictures[1][middle][..., :3])
        self.assertLess(np.median(apart), 0.1)

    def test_given_axes_are_used(self):
        ax = plt.figure().add_subplot()
        self.assertIs(hydrodip.plot_film(self.dip, ax=ax, colorbar=False), ax)

    def test_what_cannot_be_drawn_is_refused(self):
        for bad in ("strech", np.zeros(3)):
            with self.assertRaises(hydrodip.InputError):
                hydrodip.plot_film(self.dip, bad)


if __name__ == "__main__":
    unittest.main()
