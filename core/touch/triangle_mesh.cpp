#include "core/touch/triangle_mesh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/touch/embree.h"

namespace limpid {

namespace {

// Distance within which vertices are one, as a part of the mesh's diagonal. Floats round by about
// this at its far end. The two sides of a seam that was computed all the way round are off by as
// much (sin 2 pi is not zero). A larger distance is a gap.
constexpr double kSamePlace = 1e-7;

// Gives vertices within a distance of each other one name: the number of the first one queried.
// Cells are many times as large, so that most vertices reach into only one.
class NearNames {
 public:
  NearNames(const std::vector<Eigen::Vector3f>& places, double within)
      : places_(places),
        within_(within),
        cell_(within > 0 ? 64 * within : 1),
        buckets_(std::bit_ceil(places.size() + 1), kFree),
        next_(places.size(), kFree) {}

  std::uint32_t name(std::uint32_t vertex) {
    const Vec3 at = places_[vertex].cast<double>();
    const Cell low = cell_of((at.array() - within_).matrix());
    const Cell high = cell_of((at.array() + within_).matrix());
    std::uint32_t first = kFree;
    Cell cell;
    for (cell[0] = low[0]; cell[0] <= high[0]; ++cell[0]) {
      for (cell[1] = low[1]; cell[1] <= high[1]; ++cell[1]) {
        for (cell[2] = low[2]; cell[2] <= high[2]; ++cell[2]) {
          first = std::min(first, nearest_name(bucket(cell), at));
        }
      }
    }
    if (first != kFree) return first;
    std::uint32_t& own = buckets_[bucket(cell_of(at))];
    next_[vertex] = std::exchange(own, vertex);
    return vertex;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  static constexpr std::uint32_t kFree = ~std::uint32_t{0};

  Cell cell_of(const Vec3& at) const {
    const auto along = [&](int k) { return static_cast<std::int64_t>(std::floor(at[k] / cell_)); };
    return {along(0), along(1), along(2)};
  }
  std::size_t bucket(const Cell& cell) const {
    std::uint64_t h = 0;
    for (const std::int64_t x : cell) {
      h = (h ^ static_cast<std::uint64_t>(x)) * 0x9e37'79b9'7f4a'7c15;
      h ^= h >> 32;
    }
    return h & (buckets_.size() - 1);
  }
  // Returns the lowest number, for any order in the bucket.
  std::uint32_t nearest_name(std::size_t bucket, const Vec3& at) const {
    std::uint32_t first = kFree;
    for (std::uint32_t other = buckets_[bucket]; other != kFree; other = next_[other]) {
      if ((places_[other].cast<double>() - at).norm() <= within_) first = std::min(first, other);
    }
    return first;
  }

  const std::vector<Eigen::Vector3f>& places_;
  double within_, cell_;
  std::vector<std::uint32_t> buckets_;  // last entry of each bucket
  std::vector<std::uint32_t> next_;     // entry before each
};

// Extra reach of searches for the rounding of Embree's tree, as a part of the mesh's radius.
constexpr double kRounding = 1e-6;
// Difference of distances, as a part of the mesh's radius, up to which triangles are all
// considered. The order in which they come depends on the processor's kind of vectors.
constexpr double kNearlyTied = 1e-13;
// Length of the pieces in which a way is searched, as a part of the mesh's radius, and their
// largest number.
constexpr double kPiece = 1. / 32, kMostPieces = 128;
// Height below which a triangle has no direction, as a part of its longest edge.
constexpr double kSliver = 1e-9;

std::string counted(std::size_t n, const std::string& one, const std::string& several) {
  return std::to_string(n) + " " + (n == 1 ? one : several);
}
std::string counted(std::size_t n, const std::string& one) { return counted(n, one, one + "s"); }

}  // namespace

// Edges are sorted into one short list for each lower end: several times faster than sorting all.
EdgeCount count_edges(std::span<const std::uint32_t> corners, std::size_t names) {
  const auto to_corner = [](std::size_t i) { return i % 3 == 2 ? i - 2 : i + 1; };
  std::vector<std::size_t> end(names + 1);  // end of each list; while filling: its next place
  for (std::size_t i = 0; i < corners.size(); ++i) {
    ++end[std::min(corners[i], corners[to_corner(i)]) + std::size_t{1}];
  }
  std::partial_sum(end.begin(), end.end(), end.begin());
  std::vector<std::uint64_t> edges(corners.size());  // higher end; last bit: the direction
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::uint64_t from = corners[i], to = corners[to_corner(i)];
    edges[end[std::min(from, to)]++] = std::max(from, to) << 1 | (from < to ? 1 : 0);
  }
  EdgeCount count;
  for (std::size_t list = 0, i = 0; list < names; ++list) {
    std::sort(edges.begin() + static_cast<std::ptrdiff_t>(i),
              edges.begin() + static_cast<std::ptrdiff_t>(end[list]));
    while (i < end[list]) {
      std::size_t next = i + 1;
      while (next < end[list] && edges[next] >> 1 == edges[i] >> 1) ++next;
      if (next - i == 1) ++count.open;
      if (next - i > 2 || (next - i == 2 && edges[i] == edges[i + 1])) ++count.odd;
      i = next;
    }
  }
  return count;
}

// Embree's objects, and the values that it asks for while it builds.
struct TriangleMesh::Tree {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  const std::atomic<bool>* cancel = nullptr;
  std::atomic<std::ptrdiff_t> bytes{0};

  // Embree gets a thread alone: building goes on beside the haptic loop. It gets no cache for
  // tessellated surfaces, else 128 MB.
  Tree() : device(rtcNewDevice("threads=1,set_affinity=0,tessellation_cache_size=1")) {
    if (device == nullptr) throw std::runtime_error("Embree cannot be started");
    rtcSetDeviceMemoryMonitorFunction(
        device,
        [](void* tree, ssize_t change, bool) {
          static_cast<Tree*>(tree)->bytes += change;
          return true;
        },
        this);
    scene = rtcNewScene(device);
  }
  ~Tree() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  Tree(const Tree&) = delete;
  Tree& operator=(const Tree&) = delete;

  void build(const std::vector<Eigen::Vector3f>& places,
             const std::vector<std::uint32_t>& indices) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    // The places have one more element at the end: Embree reads four numbers at a time.
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               places.data(), 0, sizeof(Eigen::Vector3f), places.size());
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, indices.data(),
                               0, 3 * sizeof(std::uint32_t), indices.size() / 3);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    // Compact: its leaves name triangles instead of holding their corners.
    rtcSetSceneFlags(scene,
                     static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT));
    rtcSetSceneProgressMonitorFunction(
        scene,
        [](void* tree, double) {
          const auto* stop = static_cast<Tree*>(tree)->cancel;
          return stop == nullptr || !stop->load(std::memory_order_relaxed);
        },
        this);
    rtcCommitScene(scene);
    if (cancel != nullptr && cancel->load()) throw std::runtime_error("cancelled");
    if (rtcGetDeviceError(device) != RTC_ERROR_NONE) {
      throw std::runtime_error("no search tree can be built for the mesh: out of memory");
    }
  }
};

std::string MeshHealth::text() const {
  std::string out;
  const auto add = [&](const std::string& part) { out += (out.empty() ? "" : ", ") + part; };
  if (degenerate > 0) add(counted(degenerate, "triangle") + " with zero area ignored");
  if (odd_edges > 0)
    add(counted(odd_edges, "edge") +
        " where the surface branches or its inside and outside change places");
  if (open_edges > 0)
    add(counted(open_edges, "open edge") +
        ": the mesh is touched like a thin sheet, on both sides");
  return out;
}

// Computes areas by cross products, not by products of lengths: the thinnest triangles keep their
// digits.
Vec3 nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const Vec3 n = ab.cross(ac);
  const double w = n.dot(ab.cross(ap));
  if (d1 >= 0 && d3 <= 0 && w <= 0) return a + d1 / (d1 - d3) * ab;
  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double v = n.dot(ap.cross(ac));
  if (d2 >= 0 && d6 <= 0 && v <= 0) return a + d2 / (d2 - d6) * ac;
  if (d4 - d3 >= 0 && d5 - d6 >= 0 && n.dot(bp.cross(cp)) <= 0) {
    return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  }
  const double sum = n.squaredNorm();
  return a + v / sum * ab + w / sum * ac;
}

TriangleMesh::TriangleMesh(std::span<const Eigen::Vector3f> vertices,
                           std::span<const std::uint32_t> indices,
                           const std::atomic<bool>* cancel) {
  const auto began = std::chrono::steady_clock::now();
  keep_triangles(vertices, indices);
  tree_ = std::make_unique<Tree>();
  tree_->cancel = cancel;
  tree_->build(places_, indices_);
  tree_->cancel = nullptr;
  // A first query now loads Embree's code, so that no tick has to.
  MeshPoint near;
  nearest(corner(0, 0), radius_, MeshPoint::kNone, near);
  build_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
}

TriangleMesh::~TriangleMesh() = default;

void TriangleMesh::keep_triangles(std::span<const Eigen::Vector3f> vertices,
                                  std::span<const std::uint32_t> indices) {
  if (indices.size() % 3 != 0)
    throw std::invalid_argument("the number of indices is not a multiple of 3");
  if (indices.size() / 3 > kMostTriangles) {
    throw std::invalid_argument(std::to_string(indices.size() / 3) + " triangles; at most " +
                                std::to_string(kMostTriangles));
  }
  Eigen::AlignedBox3d box;
  for (const std::uint32_t i : indices) {
    if (i >= vertices.size()) {
      throw std::invalid_argument("index " + std::to_string(i) + " of " +
                                  counted(vertices.size(), "vertex", "vertices"));
    }
    if (!vertices[i].allFinite() || vertices[i].cwiseAbs().maxCoeff() > 1e9f) {
      throw std::invalid_argument(
          "a corner has a coordinate that is not finite or is larger than 1e9");
    }
    box.extend(vertices[i].cast<double>());
  }
  if (!box.isEmpty()) middle_ = box.center();
  std::vector<Eigen::Vector3f> places;
  places.reserve(vertices.size());
  for (const Eigen::Vector3f& v : vertices) {
    places.emplace_back((v.cast<double>() - middle_).cast<float>());
  }
  constexpr std::uint32_t kNone = MeshPoint::kNone;
  std::vector<std::uint32_t> names(places.size(), kNone);  // names of the vertices that are corners
  std::vector<std::uint32_t> renamed(places.size(), kNone);  // their indices in places_
  NearNames near(places, box.isEmpty() ? 0 : kSamePlace * box.diagonal().norm());
  std::size_t apart = 0;
  for (const std::uint32_t i : indices) {
    if (names[i] == kNone && (names[i] = near.name(i)) == i) ++apart;
  }
  indices_.reserve(indices.size());
  places_.reserve(apart + 2);
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    std::array<std::uint32_t, 3> named{};
    std::array<Eigen::Vector3f, 3> t;
    for (std::size_t k = 0; k < 3; ++k) {
      named[k] = names[indices[i + k]];
      const std::uint32_t known = renamed[named[k]];
      t[k] = known == kNone ? places[indices[i + k]] : places_[known];
    }
    const Vec3 a = t[0].cast<double>(), ab = t[1].cast<double>() - a, ac = t[2].cast<double>() - a;
    const double longest = std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()});
    if (!(ab.cross(ac).norm() > kSliver * longest) || longest < 1e-30 || named[0] == named[1] ||
        named[1] == named[2] || named[2] == named[0]) {
      ++health_.degenerate;
      continue;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& name = renamed[named[k]];
      if (name == kNone) {
        name = static_cast<std::uint32_t>(places_.size());
        places_.push_back(t[k]);
      }
      indices_.push_back(name);
    }
    for (const Eigen::Vector3f& v : t) radius_ = std::max(radius_, v.cast<double>().norm());
  }
  if (indices_.empty()) {
    throw std::invalid_argument(health_.degenerate == 0 ? "no triangles"
                                                        : "no triangle with an area");
  }
  const EdgeCount edges = count_edges(indices_, places_.size());
  health_.open_edges = edges.open;
  health_.odd_edges = edges.odd;
}

std::size_t TriangleMesh::bytes() const {
  return places_.capacity() * sizeof(Eigen::Vector3f) +
         indices_.capacity() * sizeof(std::uint32_t) +
         static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, tree_->bytes.load()));
}

bool TriangleMesh::nearest(const Vec3& at, double within, std::uint32_t hint,
                           MeshPoint& out) const noexcept {
  struct Search {
    const TriangleMesh& mesh;
    Vec3 at, point;
    double best2, margin, tied;
    std::uint32_t triangle = MeshPoint::kNone;  // the first of those equally near
    // Plane beyond which, at out . x <= level, no point is nearer than the nearest so far.
    Vec3 out = Vec3::Zero();
    double level = -1;

    bool consider(std::uint32_t t) {
      const Vec3 a = mesh.corner(t, 0), b = mesh.corner(t, 1), c = mesh.corner(t, 2);
      if (out.dot(a) <= level && out.dot(b) <= level && out.dot(c) <= level) return false;
      // Skips triangles whose plane is too far away, with room for rounding.
      const Vec3 n = (b - a).cross(c - a);
      const double height = n.dot(at - a);
      if (height * height > (1 + 1e-7) * best2 * n.squaredNorm()) return false;
      const Vec3 q = nearest_on_triangle(at, a, b, c);
      const double d2 = (q - at).squaredNorm();
      if (!(d2 < best2 || (d2 == best2 && t < triangle))) return false;
      best2 = d2;
      point = q;
      triangle = t;
      out = d2 > 0 ? Vec3((at - q) / std::sqrt(d2)) : Vec3::Zero();
      level = out.dot(q) - tied;
      return true;
    }
  };
  const double size = radius_ + at.norm();
  Search search{*this, at, Vec3::Zero(), within * within, kRounding * size, kNearlyTied * size};
  if (hint < triangles()) search.consider(hint);
  RTCPointQuery query;
  query.x = static_cast<float>(at.x());
  query.y = static_cast<float>(at.y());
  query.z = static_cast<float>(at.z());
  query.time = 0;
  query.radius = static_cast<float>(std::sqrt(search.best2) + search.margin);
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(
      tree_->scene, &query, &context,
      [](RTCPointQueryFunctionArguments* args) {
        auto& s = *static_cast<Search*>(args->userPtr);
        if (!s.consider(args->primID)) return false;
        args->query->radius = static_cast<float>(std::sqrt(s.best2) + s.margin);
        return true;
      },
      &search);
  if (search.triangle == MeshPoint::kNone) return false;
  const Vec3 a = corner(search.triangle, 0);
  out.point = search.point;
  out.normal = (corner(search.triangle, 1) - a).cross(corner(search.triangle, 2) - a).normalized();
  out.distance = std::sqrt(search.best2);
  out.triangle = search.triangle;
  return true;
}

// Embree only finds triangles near the way. Its own rays use floats, and which of two neighbours
// they hit, and where, depends on the processor.
bool TriangleMesh::crossing(const Vec3& from, const Vec3& to, MeshPoint& out) const noexcept {
  struct Search {
    const TriangleMesh& mesh;
    Vec3 from, way;
    double part = std::numeric_limits<double>::infinity();  // part of the way
    std::uint32_t triangle = MeshPoint::kNone;              // the first of those equally far

    void consider(std::uint32_t t) {
      const Vec3 a = mesh.corner(t, 0) - from, b = mesh.corner(t, 1) - from,
                 c = mesh.corner(t, 2) - from;
      const Vec3 n = (b - a).cross(c - a);
      const double height = n.dot(a), whole = n.dot(way);
      if (whole == 0 ||
          !(whole > 0 ? 0 <= height && height <= whole : whole <= height && height <= 0)) {
        return;
      }
      // Sides of the edges on which the way passes; neighbours compute the same for a shared edge,
      // so that no way slips through between them.
      const double ab = way.dot(a.cross(b)), bc = way.dot(b.cross(c)), ca = way.dot(c.cross(a));
      const bool inside = (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
      if (!inside) return;
      const double there = height / whole;
      if (!(there < part || (there == part && t < triangle))) return;
      part = there;
      triangle = t;
    }
  };
  Search search{*this, from, to - from};
  const double length = search.way.norm();
  if (!(length > 0)) return false;
  // Searches piece by piece, each in a ball: a single one around a long way would hold most of the
  // mesh.
  const double pieces = std::floor(std::min(1 + length / (kPiece * radius_), kMostPieces));
  for (double i = 0; i < pieces && search.part > i / pieces; ++i) {
    const Vec3 middle = from + (i + 0.5) / pieces * search.way;
    RTCPointQuery query;
    query.x = static_cast<float>(middle.x());
    query.y = static_cast<float>(middle.y());
    query.z = static_cast<float>(middle.z());
    query.time = 0;
    query.radius = static_cast<float>(length / pieces / 2 + kRounding * (radius_ + middle.norm()));
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(
        tree_->scene, &query, &context,
        [](RTCPointQueryFunctionArguments* args) {
          static_cast<Search*>(args->userPtr)->consider(args->primID);
          return false;
        },
        &search);
  }
  if (search.triangle == MeshPoint::kNone) return false;
  const Vec3 a = corner(search.triangle, 0);
  out.normal = (corner(search.triangle, 1) - a).cross(corner(search.triangle, 2) - a).normalized();
  out.distance = search.part * length;
  out.point = from + search.part * search.way;
  out.point -= out.normal.dot(out.point - a) * out.normal;  // onto the triangle, to round-off
  out.triangle = search.triangle;
  return true;
}

// Decides by the first triangle on the way to the middle of the nearest one: its face or its back
// is seen.
bool TriangleMesh::behind(const Vec3& at) const noexcept {
  MeshPoint near;
  if (!nearest(at, std::numeric_limits<float>::max(), MeshPoint::kNone, near)) return false;
  const std::uint32_t t = near.triangle;
  const Vec3 middle = (corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3;
  MeshPoint seen;
  if (!crossing(at, at + 1.001 * (middle - at), seen)) seen = near;
  return seen.normal.dot(middle - at) > 0;
}

}  // namespace limpid
