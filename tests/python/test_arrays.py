"""Arrays in and out: shapes, units, and whose memory they are."""

import gc
import unittest

import numpy as np

import hydrodip
from common import QUICK, InFolder, address, cone, textured_cone


class Meshes(InFolder):
    def test_arrays_are_kept_without_a_copy(self):
        vertices, faces, uv, texture = cone()
        for kind in (np.int32, np.int64):
            whole = faces.astype(kind)
            mesh = hydrodip.Mesh(vertices, whole, uv=uv, texture=texture)
            self.assertEqual(address(mesh.vertices), address(vertices))
            self.assertEqual(address(mesh.faces), address(whole))
            self.assertEqual(address(mesh.uv), address(uv))
            self.assertEqual(address(mesh.texture), address(texture))

    def test_other_types_and_orders_are_converted(self):
        vertices, faces, _, _ = cone()
        plain = hydrodip.simulate(hydrodip.Mesh(vertices, faces), **QUICK).film.positions
        for v, f in (
            (np.asfortranarray(vertices), np.asfortranarray(faces)),
            (vertices.tolist(), faces.tolist()),
            (vertices, faces.astype(np.uint16)),
            (vertices[::-1][::-1], faces.astype(float)),
        ):
            again = hydrodip.simulate(hydrodip.Mesh(v, f), **QUICK).film.positions
            np.testing.assert_array_equal(again, plain)

    def test_a_changed_array_is_read_again(self):
        vertices, faces, _, _ = cone()
        mesh = hydrodip.Mesh(vertices, faces)
        before = hydrodip.simulate(mesh, **QUICK)
        vertices *= 0.5
        after = hydrodip.simulate(mesh, **QUICK)
        self.assertAlmostEqual(2 * np.ptp(after.vertices[:, 0]), np.ptp(before.vertices[:, 0]))

    def test_whatever_has_vertices_and_faces_is_a_model(self):
        vertices, faces, uv, texture = cone()

        class Picture:  # as Pillow's
            def convert(self, mode):
                return np.dstack([texture, np.full((8, 8), 255, np.uint8)])

        class Material:
            image = Picture()

        class Visual:
            kind = "texture"
            material = Material()

        class Trimesh:
            visual = Visual()

        other = Trimesh()
        other.vertices, other.faces, other.visual.uv = vertices, faces, uv
        ours = hydrodip.design(textured_cone(), **QUICK, dpi=72, ink_rounds_max=1)
        theirs = hydrodip.design(other, **QUICK, dpi=72, ink_rounds_max=1)
        np.testing.assert_array_equal(theirs.film_image, ours.film_image)

    def test_meshio_and_ply_come_back(self):
        import meshio

        vertices, faces, _, _ = cone()
        mesh = hydrodip.Mesh(vertices, faces)
        for name in ("cone.ply", "cone.stl", "cone.obj"):
            mesh.save(name)
            again = hydrodip.Mesh.load(name)
            self.assertEqual(len(again.faces), len(faces))
            self.assertTrue(again.closed)
            np.testing.assert_allclose(np.ptp(again.vertices, axis=0), np.ptp(vertices, axis=0), rtol=1e-6)
        from_meshio = hydrodip.simulate(meshio.read("cone.ply"), **QUICK)
        from_file = hydrodip.simulate("cone.ply", **QUICK)
        for result, same in ((from_meshio, mesh), (from_file, hydrodip.Mesh.load("cone.ply"))):
            positions = hydrodip.simulate(same, **QUICK).film.positions
            np.testing.assert_array_equal(result.film.positions, positions)
        # Loaded files have their vertices in another order, and which of two faces holds film at their common edge
        # is a matter of rounding.
        np.testing.assert_allclose(from_meshio.film.positions, from_file.film.positions, atol=0.01)

    def test_what_is_no_mesh_is_refused(self):
        vertices, faces, uv, texture = cone()
        far = faces.copy()
        far[0, 0] = 10**6
        for bad in (
            hydrodip.Mesh(vertices[:, :2], faces),
            hydrodip.Mesh(vertices, far),
            hydrodip.Mesh(vertices, faces[:0]),
            hydrodip.Mesh(vertices, faces, uv=uv[:-1], texture=texture),
            hydrodip.Mesh(vertices, faces, texture=texture),
            hydrodip.Mesh(np.where(vertices > 19, np.nan, vertices), faces),
            hydrodip.Mesh(vertices, faces, uv=np.where(uv > 0.5, 1e300, uv), texture=texture),
        ):
            with self.assertRaises(hydrodip.InputError):
                hydrodip.simulate(bad, **QUICK)
        with self.assertRaises(hydrodip.InputError):
            hydrodip.Mesh(vertices, faces + 0.5)
        for share in (np.full((len(vertices), 3), 0.5), np.full((len(vertices), 3), 300)):
            with self.assertRaisesRegex(hydrodip.InputError, "0 to 255"):
                hydrodip.Mesh(vertices, faces, colors=share)
        with self.assertRaises(TypeError):
            hydrodip.simulate(3.0)


def textured_cone_file():
    vertices, faces, uv, texture = cone()
    hydrodip._core.write_png("cone.png", texture)
    with open("cone.mtl", "w") as mtl:
        mtl.write("newmtl cone\nmap_Kd cone.png\n")
    with open("cone.obj", "w") as obj:
        obj.write("mtllib cone.mtl\nusemtl cone\n")
        obj.writelines("v {} {} {}\n".format(*v) for v in vertices)
        obj.writelines("vt {} {}\n".format(*v) for v in uv)
        obj.writelines("f {0}/{0} {1}/{1} {2}/{2}\n".format(*f) for f in faces + 1)


def colored_ply(colors):
    with open("colors.ply", "w") as ply:
        ply.write("ply\nformat ascii 1.0\nelement vertex 4\n")
        ply.writelines(f"property float {axis}\n" for axis in "xyz")
        ply.writelines(f"property uchar {color}\n" for color in ("red", "green", "blue"))
        ply.write("element face 4\nproperty list uchar int vertex_indices\nend_header\n")
        for place, color in zip(("0 0 0", "40 0 0", "0 40 0", "0 0 40"), colors):
            ply.write(place + " {} {} {}\n".format(*color))
        ply.write("3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n")


def wanted(mesh):
    """The colour that is wanted in each face, as bytes."""
    dip = hydrodip.simulate(mesh, **QUICK)
    return dip.colors_at(np.arange(len(dip.faces)), np.full((len(dip.faces), 2), 0.3), predicted=False)


class Points(InFolder):
    """Places that are none have no colour, and nothing there: rows of NaN, as see() tells them, or far away."""

    def test_what_is_no_point_has_no_colour(self):
        dip = hydrodip.simulate(textured_cone(), **QUICK)
        faces = np.arange(4, dtype=np.int32)
        for none in (np.nan, np.inf, -np.inf):
            for predicted in (True, False):
                colors = dip.colors_at(faces, np.array([[0.3, 0.3], [none, 0.3], [0.3, none], [0.3, 0.3]]), predicted)
                np.testing.assert_array_equal(colors[1:3], np.zeros((2, 3)))
                self.assertTrue(colors[0].any() and colors[3].any())
        far = dip.colors_at(faces, np.full((4, 2), 1e300), False)
        self.assertEqual(far.shape, (4, 3))

    def test_a_face_that_is_none_has_no_colour(self):
        dip = hydrodip.simulate(textured_cone(), **QUICK)
        weights = np.full((4, 2), 0.3)
        faces = np.array([0, 2**32, -(2**32), 2**32 + 1])
        colors = dip.colors_at(faces, weights, False)
        self.assertTrue(colors[0].any())
        np.testing.assert_array_equal(colors[1:], np.zeros((3, 3)))
        np.testing.assert_array_equal(dip.colors_at([0], weights[:1], False), colors[:1])
        with self.assertRaisesRegex(hydrodip.InputError, "faces have to be whole numbers"):
            dip.colors_at(np.array([0.5]), weights[:1], False)

    def test_nothing_is_found_at_what_is_no_point(self):
        dip = hydrodip.simulate(textured_cone(), **QUICK)
        for none in (np.nan, np.inf, 1e300):
            self.assertTrue(np.isnan(dip.to_object(np.array([[none, 0], [0, none]]))).all())
            self.assertTrue(np.isnan(dip.to_film(np.array([[none, 0, 0], [0, 0, none]]))).all())
            faces = dip.see(np.array([[none, 0, 100.0], [0, none, 100.0]]), (0, 0, -1))[0]
            np.testing.assert_array_equal(faces, [-1, -1])
        normals = np.full((len(dip.vertices), 3), np.nan)
        dip.to_film(dip.vertices, normals)


TETRAHEDRON = "v 0 0 0\nv 40 0 0\nv 0 40 0\nv 0 0 40\nvt 0 0\nvt 1 0\nvt 0 1\n"


def two_textures():
    """A tetrahedron's file with two textured materials: its faces are red, red, blue, blue."""
    hydrodip._core.write_png("red.png", np.full((4, 4, 3), (200, 0, 0), np.uint8))
    hydrodip._core.write_png("blue.png", np.full((4, 4, 3), (0, 0, 200), np.uint8))
    with open("two.mtl", "w") as mtl:
        mtl.write("newmtl warm\nmap_Kd red.png\nnewmtl cold\nmap_Kd blue.png\n")
    with open("two.obj", "w") as obj:
        obj.write("mtllib two.mtl\n" + TETRAHEDRON + "usemtl warm\nf 1/1 3/2 2/3\nf 1/1 2/2 4/3\n")
        obj.write("usemtl cold\nf 2/1 3/2 4/3\nf 1/1 4/2 3/3\n")
    return hydrodip.Mesh.load("two.obj")


RED, BLUE, GREEN = [200, 0, 0], [0, 0, 200], [0, 200, 0]


class LoadedMeshes(InFolder):
    """What is changed of a mesh from a file is heard, and all else stays."""

    def test_arrays_of_a_file_are_changed_in_place(self):
        textured_cone_file()
        mesh = hydrodip.Mesh.load("cone.obj")
        before = wanted(mesh)
        mesh.uv += 0.5  # half a picture on: each face has another of the four colours
        self.assertTrue((wanted(mesh) != before).any(axis=1).all())
        mesh.uv -= 0.5
        np.testing.assert_array_equal(wanted(mesh), before)
        mesh.texture[:] = (*GREEN, 255)
        self.assertTrue((wanted(mesh) == GREEN).all())
        width = np.ptp(hydrodip.simulate(mesh, **QUICK).vertices[:, 0])
        mesh.vertices *= 0.5
        self.assertAlmostEqual(np.ptp(hydrodip.simulate(mesh, **QUICK).vertices[:, 0]), 0.5 * width)
        self.assertTrue((wanted(mesh) == GREEN).all())

    def test_a_sample_is_changed_in_place(self):
        mesh = hydrodip.Mesh.sample("box")
        before = np.ptp(hydrodip.simulate(mesh, **QUICK).vertices, axis=0)
        mesh.vertices *= [0.5, 1, 1]
        after = np.ptp(hydrodip.simulate(mesh, **QUICK).vertices, axis=0)
        np.testing.assert_allclose(after, before * [0.5, 1, 1])

    def test_materials_and_textures_survive_other_vertices(self):
        mesh = two_textures()
        self.assertEqual(mesh.materials, ["warm", "cold"])
        self.assertEqual(mesh.face_materials.tolist(), [0, 0, 1, 1])
        self.assertEqual([t[0, 0, :3].tolist() for t in mesh.textures], [RED, BLUE])
        self.assertEqual(wanted(mesh).tolist(), [RED, RED, BLUE, BLUE])
        mesh.vertices = 1.5 * mesh.vertices
        self.assertEqual(wanted(mesh).tolist(), [RED, RED, BLUE, BLUE])
        mesh.textures[1] = np.full((2, 2, 3), GREEN, np.uint8)
        self.assertEqual(wanted(mesh).tolist(), [RED, RED, GREEN, GREEN])
        mesh.face_materials[1] = 1
        self.assertEqual(wanted(mesh).tolist(), [RED, GREEN, GREEN, GREEN])

    def test_halves_of_a_material_are_refused(self):
        mesh = two_textures()
        with self.assertRaisesRegex(hydrodip.InputError, "face_materials have to be whole numbers"):
            mesh.face_materials = np.array([0, 0.5, 1, 1])

    def test_what_other_faces_leave_open_is_asked_for(self):
        mesh = two_textures()
        keep = [0, 2, 3]
        mesh.faces = mesh.faces[keep]
        for name in ("uv", "face_materials"):
            with self.assertRaisesRegex(hydrodip.InputError, f"there are 3 faces, and {name} for 4"):
                wanted(mesh)
            setattr(mesh, name, getattr(mesh, name)[keep])
        self.assertEqual(wanted(mesh).tolist(), [RED, BLUE, BLUE])
        mesh.face_materials[0] = 2
        with self.assertRaisesRegex(hydrodip.InputError, "2 materials"):
            wanted(mesh)

    def test_one_picture_does_not_stand_for_two(self):
        mesh = two_textures()
        with self.assertRaisesRegex(hydrodip.InputError, "2 textures"):
            mesh.texture = np.zeros((2, 2, 3), np.uint8)
        del mesh.textures[1]
        with self.assertRaisesRegex(hydrodip.InputError, "without its texture"):
            wanted(mesh)

    def test_vertex_colours_survive_other_vertices(self):
        colored_ply([RED, RED, BLUE, RED])
        mesh = hydrodip.Mesh.load("colors.ply")
        self.assertEqual(mesh.colors.shape, (4, 3, 4))
        self.assertTrue((mesh.colors[mesh.faces == mesh.faces[0, 0]] == mesh.colors[0, 0]).all())
        before = wanted(mesh)
        mesh.vertices = 1.25 * mesh.vertices
        np.testing.assert_array_equal(wanted(mesh), before)
        mesh.colors[:] = (*GREEN, 255)
        self.assertTrue((wanted(mesh) == GREEN).all())
        mesh.colors = np.full((4, 3), BLUE)  # per vertex
        self.assertTrue((wanted(mesh) == BLUE).all())
        mesh.colors = None
        self.assertTrue((wanted(mesh) == 255).all())

    def test_a_first_texture_is_the_colour(self):
        with open("plain.mtl", "w") as mtl:
            mtl.write("newmtl dark\nKd 0.1 0.1 0.1\n")
        with open("plain.obj", "w") as obj:
            obj.write("mtllib plain.mtl\n" + TETRAHEDRON + "usemtl dark\n")
            obj.write("f 1/1 3/2 2/3\nf 1/1 2/2 4/3\nf 2/1 3/2 4/3\nf 1/1 4/2 3/3\n")
        mesh = hydrodip.Mesh.load("plain.obj")
        mesh.texture = np.full((2, 2, 3), GREEN, np.uint8)
        self.assertTrue((wanted(mesh) == GREEN).all())
        mesh.uv = None
        with self.assertRaisesRegex(hydrodip.InputError, "needs uv"):
            wanted(mesh)

    def test_the_same_bytes_in_another_shape_are_another_picture(self):
        mesh = textured_cone()
        before = wanted(mesh)
        mesh.texture = mesh.texture.reshape(2, 32, 3)
        self.assertTrue((wanted(mesh) != before).any())


class Results(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.dip = hydrodip.simulate(textured_cone(), **QUICK)

    def test_views_share_the_films_memory(self):
        film = self.dip.film
        for name in ("positions", "film_coordinates", "triangles", "state", "area_ratio", "stretch",
                     "torn", "torn_at_mm", "wrinkled", "lifted"):
            one, two = getattr(film, name), getattr(self.dip.film, name)
            self.assertEqual(address(one), address(two), name)
            self.assertFalse(one.flags.writeable, name)
            self.assertFalse(one.flags.owndata, name)
        self.assertEqual(address(self.dip.vertices), address(self.dip.vertices))

    def test_views_outlive_what_they_came_from(self):
        film = hydrodip.simulate(textured_cone(), **QUICK).film
        positions = film.positions
        copy = positions.copy()
        del film
        gc.collect()
        np.zeros(10**6)  # something else in that memory, were it free
        np.testing.assert_array_equal(positions, copy)

    def test_shapes(self):
        film = self.dip.film
        n, m = len(film.positions), len(film.triangles)
        self.assertEqual(film.positions.shape, (n, 3))
        self.assertEqual(film.film_coordinates.shape, (n, 2))
        self.assertEqual(film.triangles.dtype, np.int32)
        self.assertLess(film.triangles.max(), n)
        for name in ("state", "area_ratio", "stretch", "lifted"):
            self.assertEqual(getattr(film, name).shape, (n,), name)
        for name in ("torn", "torn_at_mm", "wrinkled", "on_object"):
            self.assertEqual(getattr(film, name).shape, (m,), name)
        self.assertEqual(film.torn.dtype, np.bool_)
        self.assertEqual(film.deformation_gradient.shape, (m, 3, 2))
        self.assertEqual(film.principal_stretches.shape, (m, 2))
        self.assertTrue(set(film.state) <= {hydrodip.UNATTACHED, hydrodip.ATTACHED, hydrodip.CLAMPED})

    def test_deformation_gradient_maps_edges_and_has_the_principal_stretches(self):
        film = self.dip.film
        flat, now = film.film_coordinates[film.triangles], film.positions[film.triangles]
        for k in (1, 2):
            mapped = np.einsum("tij,tj->ti", film.deformation_gradient, flat[:, k] - flat[:, 0])
            np.testing.assert_allclose(mapped, now[:, k] - now[:, 0], atol=1e-12)
        singular = np.linalg.svd(film.deformation_gradient, compute_uv=False)
        np.testing.assert_allclose(film.principal_stretches, singular, atol=1e-7)

    def test_there_and_back(self):
        points = np.array([[5.0, -2.0], [3.0, 1.0], [-2.0, 4.0], [39.0, 29.0]])
        there = self.dip.to_object(points)
        self.assertTrue(np.isnan(there[3]).all())
        # The film's triangles are chords over the object's: not quite the same point.
        np.testing.assert_allclose(self.dip.to_film(there)[:3], points[:3], atol=0.05)

    def test_pose_matrix_takes_the_model_to_its_place(self):
        vertices = cone()[0] * 2
        dip = hydrodip.simulate(hydrodip.Mesh(vertices, cone()[1]), **QUICK, size=30, rotate=(0, 0, 90))
        self.assertAlmostEqual(np.ptp(dip.vertices[:, 0]), 30)
        placed = vertices @ dip.pose_matrix[:3, :3].T + dip.pose_matrix[:3, 3]
        np.testing.assert_allclose(placed.min(axis=0), dip.vertices.min(axis=0), atol=1e-9)
        np.testing.assert_allclose(placed.max(axis=0), dip.vertices.max(axis=0), atol=1e-9)

    def test_frames_go_from_flat_film_to_the_end(self):
        frames = self.dip.frames
        travelled = [t for t, _ in frames]
        self.assertEqual(travelled, sorted(travelled))
        self.assertEqual(np.ptp(frames[0][1][:, 2]), 0)
        self.assertEqual(frames[-1][1].shape, self.dip.film.positions.shape)

    def test_pictures(self):
        made = hydrodip.design(textured_cone(), **QUICK, dpi=72, ink_rounds_max=1)
        rows, columns = round(80 / 25.4 * 72), round(100 / 25.4 * 72)
        self.assertEqual(made.film_image.shape, (rows, columns, 4))
        self.assertEqual(made.inks.shape, made.film_image.shape)
        self.assertEqual(address(made.film_image), address(made.film_image))
        self.assertEqual(made.on_object_image.shape, made.film_image.shape)
        self.assertGreater(made.on_object_image[..., 3].max(), 0)
        picture = hydrodip.render(made, 200)
        self.assertEqual(picture.shape[1:], (200, 4))
        self.assertGreater(len(np.unique(picture.reshape(-1, 4), axis=0)), 50)

    def test_rays_meet_what_lies_there(self):
        origins = np.array([[3.0, 1.0, -50.0], [100.0, 0.0, -50.0]])
        face, weights, place, triangle, film_point = self.dip.see(origins, [0, 0, 1])
        self.assertEqual((face[1], triangle[1]), (-1, -1))
        corners = self.dip.vertices[self.dip.faces[face[0]]]
        w = np.array([1 - weights[0].sum(), *weights[0]])
        np.testing.assert_allclose(w @ corners, place[0], atol=1e-9)
        np.testing.assert_allclose(place[0, :2], [3, 1], atol=1e-6)
        np.testing.assert_allclose(self.dip.to_object(film_point[:1])[0], place[0], atol=0.05)
        film = self.dip.film
        flat = film.film_coordinates[film.triangles[triangle[0]]]
        self.assertTrue((flat.min(axis=0) <= film_point[0]).all() and (film_point[0] <= flat.max(axis=0)).all())


if __name__ == "__main__":
    unittest.main()
