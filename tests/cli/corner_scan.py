"""Writes what a scan of a dipped board would show, from the film of a job: a table of corners.

corner_scan.py FILM.ply tints|black SQUARE_MM SHIFT_X SHIFT_Y [askew] > scan.csv
The film landed SHIFT mm farther along the sheet than the job meant.
"""
import math
import struct
import sys

from film_ply import vertices


def film(path):
    """Its vertices, and three of them for each triangle."""
    points = vertices(path)
    data = open(path, "rb").read()
    at = data.index(b"end_header\n") + 11 + 29 * len(points)
    count = int(data[:at].split(b"element face ")[1].split()[0])
    return points, [struct.unpack_from("<3i", data, at + 13 * i + 1) for i in range(count)]


def corners_on_object(vertices, faces, square, middle, shift):
    """Where the corner (column, row) lies: printed there, landed by `shift` elsewhere."""
    on_object = {}
    for face in faces:
        a, b, c = (vertices[i] for i in face)
        if not all(v[5] == 1 for v in (a, b, c)):
            continue
        u = [(v[3] + shift[0], v[4] + shift[1]) for v in (a, b, c)]
        area = (u[1][0] - u[0][0]) * (u[2][1] - u[0][1]) - (u[2][0] - u[0][0]) * (u[1][1] - u[0][1])
        low = [min(p[k] for p in u) for k in (0, 1)]
        high = [max(p[k] for p in u) for k in (0, 1)]
        for column in range(math.ceil(low[0] / square + middle), math.floor(high[0] / square + middle) + 1):
            for row in range(math.ceil(low[1] / square + middle), math.floor(high[1] / square + middle) + 1):
                x, y = square * (column - middle), square * (row - middle)
                s = ((x - u[0][0]) * (u[2][1] - u[0][1]) - (u[2][0] - u[0][0]) * (y - u[0][1])) / area
                t = ((u[1][0] - u[0][0]) * (y - u[0][1]) - (x - u[0][0]) * (u[1][1] - u[0][1])) / area
                if min(s, t, 1 - s - t) < 0:
                    continue
                on_object[column, row] = tuple(
                    (1 - s - t) * a[k] + s * b[k] + t * c[k] for k in range(3))
    return on_object


def main():
    path, board, square, shift_x, shift_y = sys.argv[1:6]
    turn = 0.7 if sys.argv[6:] == ["askew"] else 0
    middle = {"tints": 0.5, "black": 0}[board]
    corners = corners_on_object(*film(path), float(square), middle, (float(shift_x), float(shift_y)))
    first = [min(place[k] for place in corners) for k in (0, 1)]
    cos, sin = math.cos(turn), math.sin(turn)
    print("column,row,x,y,z")
    for (column, row), (x, y, z) in sorted(corners.items()):
        x, y = cos * x - sin * y, sin * x + cos * y
        y, z = cos * y - sin * z, sin * y + cos * z
        print(f"{column - first[0]},{row - first[1]},{x:.5f},{y:.5f},{z:.5f}")


main()
