// glTF files whose numbers and pictures are compressed, made here by the codecs' own encoders.
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>
#include <webp/encode.h>

#include <fstream>

#include "render/model/gltf_model.h"
#include "render/model/gltf_pack.h"
#include "tests/render/model/gltf_builder.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

using Eigen::Vector3f;

// Two triangles of different size, not in a plane.
const std::array<Vector3f, 6> kSoup = {Vector3f(0, 0, 0), Vector3f(1, 0, 0), Vector3f(0, 2, 0),
                                       Vector3f(0, 0, 5), Vector3f(1, 0, 5), Vector3f(0, 4, 6)};

// Corners of all triangles, sorted: codecs change the order and number of vertices.
std::vector<std::array<float, 9>> triangles(const Model& model) {
  std::vector<std::array<float, 9>> out;
  for (std::size_t i = 0; i < model.indices.size(); i += 3) {
    std::array<std::array<float, 3>, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3f& p = model.vertices[model.indices[i + k]].position;
      corners[k] = {p.x(), p.y(), p.z()};
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    std::array<float, 9> flat{};
    for (std::size_t k = 0; k < 9; ++k) flat[k] = corners[k / 3][k % 3];
    out.push_back(flat);
  }
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<std::array<float, 9>> soup() {
  Model model;
  for (const Vector3f& p : kSoup) {
    model.indices.push_back(static_cast<std::uint32_t>(model.vertices.size()));
    model.vertices.push_back({p, Vector3f::UnitZ()});
  }
  return triangles(model);
}

// The vertex of a triangle at `place`, wherever the codec put it.
const Vertex& corner_of(const Model& model, std::size_t triangle, const Vector3f& place) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Vertex& v = model.vertices[model.indices[3 * triangle + k]];
    if (v.position == place) return v;
  }
  throw std::out_of_range("no such corner");
}

Bytes draco_bytes() {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(2);
  const int at = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  for (std::uint32_t i = 0; i < 2; ++i)
    builder.SetAttributeValuesForFace(at, draco::FaceIndex(i), kSoup[3 * i].data(),
                                      kSoup[3 * i + 1].data(), kSoup[3 * i + 2].data());
  const auto mesh = builder.Finalize();
  draco::Encoder encoder;
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
  return {buffer.data(), buffer.data() + buffer.size()};
}

GltfBuilder draco_file(const Bytes& bytes) {
  GltfBuilder file;
  const int view = file.view(bytes);
  file.attribute("POSITION", file.accessor(-1, 5126, "VEC3", 6));
  file.primitive = R"(,"indices":)" + std::to_string(file.accessor(-1, 5125, "SCALAR", 6)) +
                   R"(,"extensions":{"KHR_draco_mesh_compression":{"bufferView":)" +
                   std::to_string(view) + R"(,"attributes":{"POSITION":0}}})";
  file.more = R"(,"extensionsRequired":["KHR_draco_mesh_compression"])";
  return file;
}

TEST(GltfCompressed, ReadsDraco) {
  const GltfBuilder file = draco_file(draco_bytes());
  EXPECT_EQ(triangles(parse_gltf(file.binary(), "part.glb")), soup());
  EXPECT_TRUE(parse_gltf(file.binary(), "part.glb").parts[0].material.flat);
}

// Two triangles with an edge in common, over which the picture does not go on: more points than
// positions, as a point has a position and a place in the picture.
TEST(GltfCompressed, ReadsDracoWithASeam) {
  const std::array<Vector3f, 4> places = {Vector3f(0, 0, 0), Vector3f(1, 0, 0), Vector3f(0, 2, 0),
                                          Vector3f(3, 3, 1)};
  const std::array<std::array<std::size_t, 3>, 2> faces = {{{0, 1, 2}, {2, 1, 3}}};
  const auto uv_of = [](std::size_t face, std::size_t place) {
    return Eigen::Vector2f(0.125f * static_cast<float>(place) + 0.5f * static_cast<float>(face),
                           0.25f * static_cast<float>(place));
  };
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(2);
  const int at = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int uv = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
  for (std::uint32_t f = 0; f < 2; ++f) {
    const auto& face = faces[f];
    const std::array<Eigen::Vector2f, 3> uvs = {uv_of(f, face[0]), uv_of(f, face[1]),
                                                uv_of(f, face[2])};
    builder.SetAttributeValuesForFace(at, draco::FaceIndex(f), places[face[0]].data(),
                                      places[face[1]].data(), places[face[2]].data());
    builder.SetAttributeValuesForFace(uv, draco::FaceIndex(f), uvs[0].data(), uvs[1].data(),
                                      uvs[2].data());
  }
  const auto mesh = builder.Finalize();
  ASSERT_EQ(mesh->num_points(), 6u);
  for (const int method : {draco::MESH_EDGEBREAKER_ENCODING, draco::MESH_SEQUENTIAL_ENCODING}) {
    draco::Encoder encoder;
    encoder.SetEncodingMethod(method);
    draco::EncoderBuffer buffer;
    ASSERT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
    GltfBuilder file;
    const int view = file.view(Bytes(buffer.data(), buffer.data() + buffer.size()));
    file.attribute("POSITION", file.accessor(-1, 5126, "VEC3", 6));
    file.attribute("TEXCOORD_0", file.accessor(-1, 5126, "VEC2", 6));
    file.primitive = R"(,"indices":)" + std::to_string(file.accessor(-1, 5125, "SCALAR", 6)) +
                     R"(,"extensions":{"KHR_draco_mesh_compression":{"bufferView":)" +
                     std::to_string(view) + R"(,"attributes":{"POSITION":)" + std::to_string(at) +
                     R"(,"TEXCOORD_0":)" + std::to_string(uv) + "}}}";
    file.more = R"(,"extensionsRequired":["KHR_draco_mesh_compression"])";
    const Model model = parse_gltf(file.binary(), "part.glb");
    ASSERT_EQ(model.indices.size(), 6u);
    // The codec may give the two faces in either order.
    const auto far_one = [&](std::size_t t) {
      for (std::size_t k = 0; k < 3; ++k)
        if (model.vertices[model.indices[3 * t + k]].position == places[3]) return true;
      return false;
    };
    for (std::size_t t = 0; t < 2; ++t) {
      const std::size_t face = far_one(t) ? 1 : 0;
      for (const std::size_t place : faces[face])
        EXPECT_EQ(corner_of(model, t, places[place]).uv, uv_of(face, place))
            << "face " << face << ", corner " << place << ", method " << method;
    }
  }
}

TEST(GltfCompressed, RefusesDracoThatIsBroken) {
  Bytes bytes = draco_bytes();
  for (const std::size_t length : {std::size_t{1}, bytes.size() / 2, bytes.size() - 1}) {
    const GltfBuilder file =
        draco_file(Bytes(bytes.begin(), bytes.begin() + static_cast<long>(length)));
    EXPECT_THROW(parse_gltf(file.binary(), "part.glb"), std::runtime_error) << length;
  }
}

std::string meshopt(int buffer, std::size_t at, std::size_t length, std::size_t stride,
                    std::size_t count, const std::string& mode) {
  return R"({"buffer":1,"byteLength":)" + std::to_string(stride * count) +
         R"(,"extensions":{"EXT_meshopt_compression":{"buffer":)" + std::to_string(buffer) +
         R"(,"byteOffset":)" + std::to_string(at) + R"(,"byteLength":)" + std::to_string(length) +
         R"(,"byteStride":)" + std::to_string(stride) + R"(,"count":)" + std::to_string(count) +
         R"(,"mode":")" + mode + "\"}}}";
}

// Positions and indices compressed; the second buffer exists in name only.
Bytes meshopt_file(const std::string& fallback) {
  Bytes data(meshopt_encodeVertexBufferBound(6, sizeof(Vector3f)));
  data.resize(
      meshopt_encodeVertexBuffer(data.data(), data.size(), kSoup.data(), 6, sizeof(Vector3f)));
  const std::size_t first = data.size();
  data.resize((data.size() + 3) / 4 * 4);
  const std::size_t at = data.size();
  const std::array<std::uint32_t, 6> corners = {0, 1, 2, 3, 4, 5};
  Bytes indices(meshopt_encodeIndexBufferBound(6, 6));
  indices.resize(meshopt_encodeIndexBuffer(indices.data(), indices.size(), corners.data(), 6));
  data.insert(data.end(), indices.begin(), indices.end());
  const std::string json =
      R"({"asset":{"version":"2.0"},"extensionsRequired":["EXT_meshopt_compression"],)"
      R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)"
      R"("accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":6},)"
      R"({"bufferView":1,"componentType":5125,"type":"SCALAR","count":6}],"bufferViews":[)" +
      meshopt(0, 0, first, sizeof(Vector3f), 6, "ATTRIBUTES") + "," +
      meshopt(0, at, indices.size(), 4, 6, "TRIANGLES") + R"(],"buffers":[{"byteLength":)" +
      std::to_string(data.size()) + R"(},{"byteLength":100000)" + fallback + "}]}";
  return glb(json, data);
}

TEST(GltfCompressed, ReadsMeshoptWithABufferThatIsNotThere) {
  for (const char* fallback :
       {"", R"(,"extensions":{"EXT_meshopt_compression":{"fallback":true}})"})
    EXPECT_EQ(triangles(parse_gltf(meshopt_file(fallback), "part.glb")), soup());
}

// Adds elements of `stride` bytes as a compressor stores them; `filter`: what was done to them.
int filtered_view(GltfBuilder& file, const Bytes& filtered, std::size_t stride,
                  const std::string& filter) {
  const std::size_t count = filtered.size() / stride;
  Bytes data(meshopt_encodeVertexBufferBound(count, stride));
  data.resize(meshopt_encodeVertexBuffer(data.data(), data.size(), filtered.data(), count, stride));
  const std::string each = R"("byteStride":)" + std::to_string(stride);
  file.more = R"(,"extensionsRequired":["EXT_meshopt_compression"])";
  return file.view(data, R"(,"extensions":{"EXT_meshopt_compression":{"buffer":0,"byteOffset":)" +
                             std::to_string((file.data.size() + 3) / 4 * 4) + R"(,"byteLength":)" +
                             std::to_string(data.size()) + "," + each + R"(,"count":)" +
                             std::to_string(count) + R"(,"mode":"ATTRIBUTES","filter":")" + filter +
                             R"("}},)" + each);
}

// Unit vectors folded into a plane, in four bytes or eight.
TEST(GltfCompressed, ReadsMeshoptNormalsOfEitherWidth) {
  const std::array<Eigen::Vector4f, 3> normals = {Eigen::Vector4f(0.6f, 0, 0.8f, 0),
                                                  Eigen::Vector4f(0, -0.8f, -0.6f, 0),
                                                  Eigen::Vector4f(-0.36f, 0.48f, 0.8f, 0)};
  for (const std::size_t stride : {4u, 8u}) {
    Bytes filtered(3 * stride);
    meshopt_encodeFilterOct(filtered.data(), 3, stride, stride == 4 ? 8 : 12, normals[0].data());
    GltfBuilder file;
    file.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
    const int view = filtered_view(file, filtered, stride, "OCTAHEDRAL");
    file.attribute("NORMAL", file.accessor(view, stride == 4 ? 5120 : 5122, "VEC3", 3,
                                           R"(,"normalized":true)"));
    const Model model = parse_gltf(file.binary(), "part.glb");
    ASSERT_EQ(model.vertices.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3f off = model.vertices[i].normal - normals[i].head<3>();
      EXPECT_LT(off.norm(), stride == 4 ? 0.02 : 0.002) << i << " of " << stride << " bytes";
    }
  }
}

// Four numbers whose squares add up to one, of which three are stored; here as colours, as turns of
// nodes are not stored in views.
TEST(GltfCompressed, ReadsMeshoptQuaternions) {
  const std::array<Eigen::Vector4f, 3> turns = {Eigen::Vector4f(0.5f, 0.5f, 0.5f, 0.5f),
                                                Eigen::Vector4f(0, 0.6f, 0, 0.8f),
                                                Eigen::Vector4f(0.9f, 0.1f, 0.3f, 0.3f)};
  Bytes filtered(3 * 8);
  meshopt_encodeFilterQuat(filtered.data(), 3, 8, 12, turns[0].data());
  GltfBuilder file;
  file.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const int view = filtered_view(file, filtered, 8, "QUATERNION");
  file.attribute("COLOR_0", file.accessor(view, 5122, "VEC4", 3, R"(,"normalized":true)"));
  const Model model = parse_gltf(file.binary(), "part.glb");
  ASSERT_EQ(model.vertices.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    // Things without a material have a shade of their own, which scales the colours.
    const Vector3f read = model.vertices[i].color.normalized();
    EXPECT_LT((read - turns[i].head<3>().normalized()).norm(), 0.002) << i;
  }
}

// Numbers of 24 bits below the 8 bits of their exponent: 3 * 2^-2, -5 and 1 * 2^4, then 1.
TEST(GltfCompressed, ReadsMeshoptNumbersWithAnExponentOfTheirOwn) {
  GltfBuilder file;
  Bytes filtered;
  append_values<std::uint32_t>(filtered,
                               {0, 0, 0, 0xFE000003, 0x00FFFFFB, 0x04000001, 0, 0x00000001, 0});
  const int view = filtered_view(file, filtered, sizeof(Vector3f), "EXPONENTIAL");
  file.attribute("POSITION", file.accessor(view, 5126, "VEC3", 3));
  const Model model = parse_gltf(file.binary(), "part.glb");
  ASSERT_EQ(model.vertices.size(), 3u);
  EXPECT_EQ(model.vertices[0].position, Vector3f(0, 0, 0));
  EXPECT_EQ(model.vertices[1].position, Vector3f(0.75f, -5, 16));
  EXPECT_EQ(model.vertices[2].position, Vector3f(0, 1, 0));
}

// Each filter works on elements of its own size; all others are refused.
TEST(GltfCompressed, RefusesAMeshoptFilterThatDoesNotFit) {
  struct Case {
    const char* filter;
    std::size_t stride;
  };
  for (const auto& [filter, stride] :
       {Case{"OCTAHEDRAL", 12}, Case{"OCTAHEDRAL", 16}, Case{"QUATERNION", 4},
        Case{"QUATERNION", 16}, Case{"COLOR", 8}, Case{"exponential", 12}}) {
    GltfBuilder file;
    file.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
    const int view = filtered_view(file, Bytes(3 * stride), stride, filter);
    file.attribute("NORMAL", file.accessor(view, 5120, "VEC3", 3, R"(,"normalized":true)"));
    std::string said;
    try {
      parse_gltf(file.binary(), "part.glb");
    } catch (const std::runtime_error& error) {
      said = error.what();
    }
    EXPECT_EQ(said, "part.glb: buffer view 1 cannot be decompressed") << filter << stride;
  }
}

// The compressed bytes lie in the second of two companion files, at an odd offset. The third buffer
// does not exist.
TEST(GltfCompressed, PacksMeshoptWithFilesBesideIt) {
  const test::TempDir dir;
  Bytes data(meshopt_encodeVertexBufferBound(6, sizeof(Vector3f)));
  data.resize(
      meshopt_encodeVertexBuffer(data.data(), data.size(), kSoup.data(), 6, sizeof(Vector3f)));
  Bytes second(3, 0xEE);
  second.insert(second.end(), data.begin(), data.end());
  Bytes first(5, 0xDD);
  append_values<std::uint8_t>(first, {0, 1, 2, 3, 4, 5});
  const auto write = [&](const char* name, const Bytes& bytes) {
    std::ofstream(dir / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  };
  write("first.bin", first);
  write("second.bin", second);
  const std::string text =
      R"({"asset":{"version":"2.0"},"extensionsRequired":["EXT_meshopt_compression"],)"
      R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)"
      R"("accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":6},)"
      R"({"bufferView":1,"componentType":5121,"type":"SCALAR","count":6}],"bufferViews":[)"
      R"({"buffer":2,"byteLength":72,"extensions":{"EXT_meshopt_compression":{"buffer":1,)"
      R"("byteOffset":3,"byteLength":)" +
      std::to_string(data.size()) +
      R"(,"byteStride":12,"count":6,"mode":"ATTRIBUTES"}}},)"
      R"({"buffer":0,"byteOffset":5,"byteLength":6}],"buffers":[)"
      R"({"byteLength":11,"uri":"first.bin"},{"byteLength":)" +
      std::to_string(second.size()) +
      R"(,"uri":"second.bin"},{"byteLength":72,"extensions":)"
      R"({"EXT_meshopt_compression":{"fallback":true}}}]})";
  const Bytes bytes(text.begin(), text.end());
  ASSERT_EQ(triangles(parse_gltf(bytes, "part.gltf", dir / "")), soup());
  const Bytes packed = pack_gltf(bytes, "part.gltf", dir / "");
  ASSERT_FALSE(packed.empty());
  EXPECT_EQ(triangles(parse_gltf(packed, "part.glb")), soup());
}

// Readers know a picture within a file by the kind that it says.
TEST(GltfPack, SaysTheKindOfThePicturesThatItBringsIn) {
  const test::TempDir dir;
  const auto write = [&](const char* name, const Bytes& bytes) {
    std::ofstream(dir / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  };
  write("red.png", kRedPng);
  write("photo", {0xFF, 0xD8, 0xFF, 0xD9});
  write("web", {'R', 'I', 'F', 'F', 4, 0, 0, 0, 'W', 'E', 'B', 'P'});
  GltfBuilder file;
  file.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  write("data.bin", file.data);
  file.uri = "data.bin";
  file.more = R"(,"images":[{"uri":"red.png"},{"uri":"photo"},{"uri":"web"},)"
              R"({"uri":"red.png","mimeType":"image/own"}])";
  const Bytes packed = pack_gltf(file.text(), "part.gltf", dir / "");
  const std::string all(packed.begin(), packed.end());
  const auto at = [&](const char* kind) { return all.find("\"mimeType\":\"" + std::string(kind)); };
  ASSERT_NE(at("image/png"), std::string::npos);
  ASSERT_NE(at("image/jpeg"), std::string::npos);
  ASSERT_NE(at("image/webp"), std::string::npos);
  ASSERT_NE(at("image/own"), std::string::npos) << "as the file says";
  EXPECT_LT(at("image/png"), at("image/jpeg"));
  EXPECT_LT(at("image/jpeg"), at("image/webp"));
  EXPECT_EQ(all.find("\"uri\""), std::string::npos) << "nothing lies outside any more";
  EXPECT_NE(std::search(packed.begin(), packed.end(), kRedPng.begin(), kRedPng.end()),
            packed.end());
}

TEST(GltfCompressed, RefusesMeshoptThatIsBroken) {
  Bytes bytes = meshopt_file("");
  for (std::size_t i = bytes.size() - 60; i < bytes.size(); i += 7) {
    Bytes broken = bytes;
    broken[i] = static_cast<unsigned char>(~broken[i]);
    try {
      parse_gltf(broken, "part.glb");
    } catch (const std::runtime_error& e) {
      EXPECT_EQ(std::string(e.what()).find("part.glb: "), 0u);
    }
  }
  const std::string odd = R"("count":5)";
  std::string text(bytes.begin(), bytes.end());
  text.replace(text.rfind(R"("count":6)"), odd.size(), odd);  // number of triangles' corners
  EXPECT_THROW(parse_gltf(Bytes(text.begin(), text.end()), "part.glb"), std::runtime_error);
}

// Four pixels, encoded without loss.
const std::array<std::uint8_t, 16> kPixels = {255, 0, 0,   255, 0, 255, 0, 255,
                                              0,   0, 255, 255, 9, 8,   7, 200};

Bytes webp() {
  std::uint8_t* out = nullptr;
  const std::size_t size = WebPEncodeLosslessRGBA(kPixels.data(), 2, 2, 8, &out);
  Bytes bytes(out, out + size);
  WebPFree(out);
  return bytes;
}

GltfBuilder textured(const std::string& texture, const Bytes& picture) {
  GltfBuilder file;
  file.positions(kSquare);
  file.attribute("TEXCOORD_0", file.accessor(file.view(std::vector<float>(8)), 5126, "VEC2", 4));
  const int view = file.view(picture);
  file.primitive = R"(,"mode":5,"material":0)";
  file.more =
      R"(,"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],"textures":[)" +
      texture + R"(],"images":[{"mimeType":"image/webp","bufferView":)" + std::to_string(view) +
      "}]";
  return file;
}

TEST(GltfCompressed, ReadsWebP) {
  const Model model = parse_gltf(
      textured(R"({"extensions":{"EXT_texture_webp":{"source":0}}})", webp()).binary(), "part.glb");
  ASSERT_EQ(model.images.size(), 1u);
  EXPECT_TRUE(std::equal(kPixels.begin(), kPixels.end(), model.images[0].rgba.begin(),
                         model.images[0].rgba.end()));
}

// Base64 has plus signs, which are blanks in the URIs of web forms.
TEST(GltfCompressed, ReadsWebPInAUri) {
  GltfBuilder file = textured(R"({"extensions":{"EXT_texture_webp":{"source":0}}})", webp());
  file.more.resize(file.more.find(R"("images")"));
  file.more +=
      R"("images":[{"uri":"data:image/webp;base64,UklGRiYAAABXRUJQVlA4TBoAAAAvAUAAAA/wg34CAYrC)"
      R"(/8ue8Dv/YX4YgYj+hw=="}])";
  const Model model = parse_gltf(file.binary(), "part.glb");
  EXPECT_TRUE(model.warnings.empty());
  ASSERT_EQ(model.images.size(), 1u);
  EXPECT_EQ(model.images[0].rgba,
            (Bytes{4, 7, 9, 255, 4, 7, 9, 255, 4, 7, 9, 255, 3, 4, 200, 255}));
}

TEST(GltfCompressed, LeavesABrokenWebPOut) {
  Bytes half = webp();
  half.resize(half.size() / 2);
  const Model model = parse_gltf(
      textured(R"({"extensions":{"EXT_texture_webp":{"source":0}}})", half).binary(), "a.glb");
  EXPECT_TRUE(model.images.empty());
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_NE(model.warnings[0].find("not a PNG, JPEG or WebP"), std::string::npos);
}

TEST(GltfCompressed, StaysTouchableWithoutAPictureOfAnUnknownKind) {
  GltfBuilder file =
      textured(R"({"extensions":{"KHR_texture_basisu":{"source":0}}})", {1, 2, 3, 4});
  file.more += R"(,"extensionsRequired":["KHR_texture_basisu"])";
  const Model model = parse_gltf(file.binary(), "part.glb");
  EXPECT_EQ(model.indices.size(), 6u);
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_NE(model.warnings[0].find("KHR_texture_basisu"), std::string::npos);
}

// Each of these numbers is needed: without it nothing is decompressed.
TEST(GltfCompressed, RefusesMeshoptWithoutItsNumbers) {
  const Bytes whole = meshopt_file("");
  const std::string all(whole.begin(), whole.end());
  for (const std::string missing : {R"("count":6,"mode")", R"("byteStride":12)",
                                    R"("mode":"ATTRIBUTES")", R"("byteLength":)"}) {
    std::string text = all;
    const std::size_t at = missing == R"("byteLength":)"
                               ? text.find(missing, text.find("EXT_meshopt_compression\":{"))
                               : text.find(missing);
    ASSERT_NE(at, text.npos) << missing;
    text[at + 1] = 'X';  // a key that nobody reads
    EXPECT_THROW(parse_gltf(Bytes(text.begin(), text.end()), "part.glb"), std::runtime_error)
        << missing;
  }
}

}  // namespace
}  // namespace limpid
