// Numbers out of a glTF file's buffers, with every reference and every range checked.
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>

#include "core/math/sizes.h"

namespace limpid {

// What a typed element of an accessor looks like in memory, after all of it was checked.
struct Elements {
  const unsigned char* first = nullptr;
  std::size_t count = 0, stride = 0;
  int components = 0, component_type = 0;
  bool normalized = false;
  std::shared_ptr<const std::vector<unsigned char>> own;  // of what no buffer holds as it is
};

class GltfAccessor {
 public:
  // `name` stands for the file in messages; both outlive this.
  GltfAccessor(const tinygltf::Model& gltf, const std::string& name) : gltf_(gltf), name_(name) {}

  // All of these throw std::runtime_error naming the file for what does not exist or fit.
  Elements elements(int accessor);
  std::span<const unsigned char> view(int buffer_view);
  Eigen::Vector4f element(const Elements& e, std::size_t i) const;  // missing parts: 0 0 0 1
  std::uint32_t index(const Elements& e, std::size_t i) const;

  Eigen::Matrix4f matrix(const Elements& e, std::size_t i) const;  // of an accessor of MAT4

  struct Kind {
    int components = 0, component_type = 0;
  };
  Kind kind(int accessor) const;
  // From now on the accessor has these elements, packed; of the file's component type if it is 0.
  void replace(int accessor, std::vector<unsigned char> bytes, int component_type = 0);

  template <class List>
  const auto& at(const List& list, int index, const char* what) const {
    if (index < 0 || static_cast<std::size_t>(index) >= list.size())
      refuse(std::string(what) + " " + std::to_string(index) + " does not exist, the file has " +
             std::to_string(list.size()));
    return list[static_cast<std::size_t>(index)];
  }
  [[noreturn]] void refuse(const std::string& why) const;

 private:
  std::span<const unsigned char> part(int buffer, std::size_t offset, std::size_t length,
                                      int view) const;
  void fill_in(const tinygltf::Accessor& accessor, Elements& e);
  void take(std::size_t bytes);  // of memory for what no buffer holds as it is

  const tinygltf::Model& gltf_;
  const std::string& name_;
  std::size_t own_bytes_ = 0;                        // taken so far
  std::map<int, std::vector<unsigned char>> views_;  // decompressed
  std::map<int, Elements> replaced_;                 // accessors
};

}  // namespace limpid
