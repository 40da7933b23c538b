"""What the module's tests share: small models, quick settings, the program."""

import os
import subprocess
import tempfile
import unittest

import numpy as np

import hydrodip

HYDRODIP = os.environ["HYDRODIP"]  # the command line's program

# Settings that make a dip quick, for the module and for the command line.
QUICK = {"film": (100, 80), "film_elements": 800, "dip_step_mm": 1.0, "dip_air_cells": 0}
QUICK_OPTIONS = (
    "--film 100x80 --set film.elements=800 --set dip.step_mm=1 --set dip.air_cells=0 "
    "--set preview.pictures=off"
).split()


def cone(n=24, radius=20.0, height=15.0):
    """A cone with its tip at the bottom, per-vertex uv, and a texture of four colours."""
    angle = 2 * np.pi * np.arange(n) / n
    ring = np.stack([radius * np.cos(angle), radius * np.sin(angle), np.full(n, height)], axis=1)
    vertices = np.concatenate([ring, [[0, 0, 0], [0, 0, height]]])
    side = [[n, (k + 1) % n, k] for k in range(n)]
    top = [[n + 1, k, (k + 1) % n] for k in range(n)]
    faces = np.array(side + top, dtype=np.int32)
    uv = 0.5 + vertices[:, :2] / (2.2 * radius)
    texture = np.zeros((8, 8, 3), dtype=np.uint8)
    texture[:4, :4], texture[:4, 4:] = (200, 40, 40), (40, 160, 60)
    texture[4:, :4], texture[4:, 4:] = (40, 60, 200), (230, 200, 40)
    return vertices, faces, uv, texture


def textured_cone():
    vertices, faces, uv, texture = cone()
    return hydrodip.Mesh(vertices, faces, uv=uv, texture=texture)


def address(array):
    return array.__array_interface__["data"][0]


def run(*arguments, check=True):
    return subprocess.run([HYDRODIP, *map(str, arguments)], check=check, capture_output=True)


class InFolder(unittest.TestCase):
    """Works in a folder of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        before = os.getcwd()
        os.chdir(folder.name)
        self.addCleanup(os.chdir, before)
