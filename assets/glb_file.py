"""Writes triangles with PBR materials as binary glTF. Needs numpy only (Debian: python3-numpy).

Coordinates are metres with z up, the axes of the device's base frame, and are written as they are:
a model stands in a scene without being turned. (Viewers that hold y for up show it lying on its
back; a model that was made for them stands up in a scene with rpy = [1.5708, 0, 0].)"""

import json
import struct

import numpy as np

KIND = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}
FLOAT, BYTE, UINT = 5126, 5121, 5125
VERTICES, INDICES = 34962, 34963


class Part:
    """Triangles of one material. points, normals: N x 3; triangles: M x 3, counter-clockwise from
    outside; colors (linear, times the material's) N x 3, uv (v down) N x 2: optional."""

    def __init__(self, material, points, normals, triangles, colors=None, uv=None):
        self.material, self.points, self.normals = material, points, normals
        self.triangles, self.colors, self.uv = triangles, colors, uv


# Column by column: z up becomes y up.
Y_UP = [1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1]


def write_glb(path, parts, materials, generator, y_up=False):
    """materials: name -> (r, g, b linear, metallic, roughness), or a dictionary with `color`,
    `metallic`, `roughness` and optionally `picture` (a PNG's bytes) and `two_sided`. y_up: turned
    as the format has it, which is what arms expect of their pictures. Returns the number of
    triangles."""
    blob = bytearray()
    views, accessors, primitives, used, pictures = [], [], [], [], []

    def view(data, **more):
        views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": len(data), **more})
        blob.extend(data + b"\0" * (-len(data) % 4))
        return len(views) - 1

    def accessor(array, component, target, **more):
        """array: count x components."""
        accessors.append({"bufferView": view(array.tobytes(), target=target),
                          "componentType": component, "count": len(array),
                          "type": KIND[array.shape[1]], **more})
        return len(accessors) - 1

    for part in parts:
        points = part.points.astype("<f4")
        attributes = {
            "POSITION": accessor(points, FLOAT, VERTICES,
                                 min=points.min(0).tolist(), max=points.max(0).tolist()),
            "NORMAL": accessor(part.normals.astype("<f4"), FLOAT, VERTICES)}
        if part.colors is not None:
            rgba = np.column_stack([np.clip(part.colors, 0, 1), np.ones(len(points))])
            attributes["COLOR_0"] = accessor(np.round(rgba * 255).astype("u1"), BYTE, VERTICES,
                                             normalized=True)
        if part.uv is not None:
            attributes["TEXCOORD_0"] = accessor(part.uv.astype("<f4"), FLOAT, VERTICES)
        primitives.append({
            "attributes": attributes,
            "indices": accessor(part.triangles.reshape(-1, 1).astype("<u4"), UINT, INDICES),
            "material": len(used)})
        material = materials[part.material]
        if not isinstance(material, dict):
            material = dict(color=material[:3], metallic=material[3], roughness=material[4])
        pbr = {"baseColorFactor": [*material["color"], 1], "metallicFactor": material["metallic"],
               "roughnessFactor": material["roughness"]}
        if "picture" in material:
            pbr["baseColorTexture"] = {"index": len(pictures)}
            pictures.append({"bufferView": view(material["picture"]), "mimeType": "image/png"})
        used.append({"name": part.material, "pbrMetallicRoughness": pbr,
                     **({"doubleSided": True} if material.get("two_sided") else {})})

    gltf = {"asset": {"version": "2.0", "generator": generator}, "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0, **({"matrix": Y_UP} if y_up else {})}],
            "meshes": [{"primitives": primitives}], "materials": used, "accessors": accessors,
            "bufferViews": views, "buffers": [{"byteLength": len(blob)}]}
    if pictures:
        gltf["images"] = pictures
        gltf["textures"] = [{"source": i} for i in range(len(pictures))]
    text = json.dumps(gltf, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<III", 0x46546C67, 2, 28 + len(text) + len(blob)))
        file.write(struct.pack("<II", len(text), 0x4E4F534A) + text)
        file.write(struct.pack("<II", len(blob), 0x004E4942) + blob)
    return sum(len(part.triangles) for part in parts)


def grid_triangles(rows, columns, around=False):
    """Of rows x columns points in order; `around`: the last column meets the first. Outside is
    left of the rows' direction seen along the columns."""
    index = np.arange(rows * columns).reshape(rows, columns)
    if around:
        index = np.column_stack([index, index[:, 0]])
    a, b, c, d = index[:-1, :-1], index[:-1, 1:], index[1:, :-1], index[1:, 1:]
    return np.concatenate([np.stack([a, b, d], -1).reshape(-1, 3),
                           np.stack([a, d, c], -1).reshape(-1, 3)])


def thinning_triangles(fine, coarse, every):
    """Between a row of points and one with every `every`-th of its places: indices fine .. on, then
    coarse .. on; the same sense as grid_triangles from the fine row to the coarse one. Both rows
    end with a point of their own, len(fine) = every * (len(coarse) - 1) + 1."""
    fans = []
    for k in range(every):
        fans.append(np.stack([fine[k:-1:every], fine[k + 1::every], coarse[:-1]], -1))
    fans.append(np.stack([fine[every::every], coarse[1:], coarse[:-1]], -1))
    return np.concatenate(fans)


# Numbers that are whole multiples of these pack better, and nobody sees or feels the difference.
GRAIN = 2.0**-20   # of positions [m]
TURN = 2.0**-10    # of normals


def whole(points, grain=GRAIN):
    return np.round(points / grain) * grain


def smooth_normals(points, triangles):
    """Area-weighted, so that a flat face next to a narrow rounding stays flat. Of unit length up to
    a thousandth."""
    face = np.cross(points[triangles[:, 1]] - points[triangles[:, 0]],
                    points[triangles[:, 2]] - points[triangles[:, 0]])
    normals = np.zeros_like(points)
    for corner in range(3):
        np.add.at(normals, triangles[:, corner], face)
    return whole(unit(normals), TURN)


def unit(vectors):
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.where(length > 0, vectors / np.maximum(length, 1e-30), [0, 0, 1])
