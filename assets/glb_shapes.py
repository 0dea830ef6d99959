"""Rounded solids with smooth normals and PBR materials, written as binary glTF.

Needs numpy only (Debian: python3-numpy)."""

import numpy as np

from glb_file import Part, grid_triangles, write_glb

AXES = {"x": (1, 2, 0), "y": (2, 0, 1), "z": (0, 1, 2)}


def rounded(corners, steps=4):
    """A profile [(radius, height)] from corners [(radius, height, fillet)]; the ends stay sharp."""
    points = [corners[0][:2]]
    for before, (r, h, fillet), after in zip(corners, corners[1:], corners[2:]):
        here = np.array([r, h])
        a = np.array(before[:2]) - here
        b = np.array(after[:2]) - here
        a, b = a / np.linalg.norm(a), b / np.linalg.norm(b)
        half = np.arccos(np.clip(a @ b, -1, 1)) / 2
        reach = fillet / np.tan(half)
        for t in np.linspace(0, 1, steps + 1):  # a quadratic curve is close enough to an arc
            points.append(here + reach * ((1 - t) ** 2 * a + t**2 * b))
    points.append(corners[-1][:2])
    return [tuple(p) for p in points]


class Shape:
    """Collects grids of points, one list of triangles a material."""

    def __init__(self):
        self.parts = {}

    def grid(self, points, material):
        """points: rows x columns x 3, closed along the columns; outside is left of the rows'
        direction seen along the columns."""
        rows, columns, _ = points.shape
        triangles = grid_triangles(rows, columns, around=True)
        flat = points.reshape(-1, 3)
        face = np.cross(flat[triangles[:, 1]] - flat[triangles[:, 0]],
                        flat[triangles[:, 2]] - flat[triangles[:, 0]])
        triangles, face = (x[np.linalg.norm(face, axis=1) > 1e-14] for x in (triangles, face))
        normals = np.zeros_like(flat)
        for corner in range(3):
            np.add.at(normals, triangles[:, corner], face)
        normals = normals.reshape(rows, columns, 3)
        for row in (0, -1):  # all points of a pole share one normal
            if np.ptp(points[row], axis=0).max() < 1e-9:
                normals[row] = normals[row].sum(axis=0)
        normals = normals.reshape(-1, 3)
        length = np.linalg.norm(normals, axis=1, keepdims=True)
        normals = np.where(length > 0, normals / np.maximum(length, 1e-30), [0, 0, 1])
        self.parts.setdefault(material, []).append((flat, normals, triangles))

    def turned(self, profile, axis, material, centre=(0, 0, 0), segments=28):
        """A solid of revolution about `axis`; profile [(radius, height)], heights rising."""
        angle = np.linspace(0, 2 * np.pi, segments, endpoint=False)
        u, v, w = AXES[axis]
        points = np.empty((len(profile), segments, 3))
        for row, (radius, height) in enumerate(profile):
            points[row, :, u] = radius * np.cos(angle)
            points[row, :, v] = radius * np.sin(angle)
            points[row, :, w] = height
        self.grid(points + np.array(centre), material)

    def disc(self, radius, thickness, fillet, axis, material, centre, segments=28, steps=3):
        """A rounded cylinder, its centre at `centre`."""
        h = thickness / 2
        profile = rounded([(0, -h, 0), (radius, -h, fillet), (radius, h, fillet), (0, h, 0)], steps)
        self.turned(profile, axis, material, centre, segments)

    def ball(self, radius, material, centre, segments=20, rows=10):
        t = np.linspace(-np.pi / 2, np.pi / 2, rows + 1)
        self.turned(list(zip(radius * np.cos(t), radius * np.sin(t))), "z", material, centre,
                    segments)

    def loft(self, rows, axis, material, segments=28):
        """Superellipses along an axis; rows (along, centre u, centre v, half u, half v, exponent)
        with u, v, axis right-handed."""
        angle = np.linspace(0, 2 * np.pi, segments, endpoint=False)
        u, v, w = AXES[axis]
        points = np.empty((len(rows), segments, 3))
        for k, (along, cu, cv, a, b, n) in enumerate(rows):
            c, s = np.cos(angle), np.sin(angle)
            points[k, :, u] = cu + a * np.sign(c) * np.abs(c) ** (2 / n)
            points[k, :, v] = cv + b * np.sign(s) * np.abs(s) ** (2 / n)
            points[k, :, w] = along
        self.grid(points, material)

    def write(self, path, materials, y_up=False):
        """materials: name -> (r, g, b linear, metallic, roughness)."""
        parts = []
        for name, pieces in self.parts.items():
            first = np.cumsum([0] + [len(p[0]) for p in pieces])
            parts.append(Part(name, np.concatenate([p[0] for p in pieces]),
                              np.concatenate([p[1] for p in pieces]),
                              np.concatenate([p[2] + k for p, k in zip(pieces, first)])))
        return write_glb(path, parts, materials, "glb_shapes.py", y_up)
