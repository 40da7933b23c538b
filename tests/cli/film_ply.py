"""What the tests ask of a film.ply.

film_ply.py places FILM.ply SHIFT_X > places.csv   places on the object that show what was printed
                                                   SHIFT_X mm farther along the sheet than meant
film_ply.py shifted A.ply B.ply SHIFT_X LIMIT      fails unless film laid in both was printed that
                                                   much farther in B, within LIMIT mm
"""
import struct
import sys


def vertices(path):
    """x, y, z, u, v, state, area ratio, stretch."""
    data = open(path, "rb").read()
    begin = data.index(b"end_header\n") + 11
    count = int(data[:begin].split(b"element vertex ")[1].split()[0])
    return [struct.unpack_from("<5fB2f", data, begin + 29 * i) for i in range(count)]


def places(film, shift):
    print("film_x_mm,film_y_mm,x,y,z")
    for x, y, z, u, v, state, *_ in vertices(film):
        if state == 1:
            print(f"{u + float(shift):.6f},{v:.6f},{x:.6f},{y:.6f},{z:.6f}")


def shifted(first, second, shift, limit):
    a, b = vertices(first), vertices(second)
    assert len(a) == len(b)
    laid = [(p, q) for p, q in zip(a, b) if p[5] == 1 and q[5] == 1]
    assert laid
    worst = max(max(abs(q[3] - p[3] - float(shift)), abs(q[4] - p[4])) for p, q in laid)
    assert worst < float(limit), worst


if __name__ == "__main__":
    {"places": places, "shifted": shifted}[sys.argv[1]](*sys.argv[2:])
