// STL, OBJ, PLY and Collada models read by assimp, with their materials and pictures.
#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/base/model_kinds.h"
#include "render/model/assimp/assimp_files.h"
#include "render/model/model.h"

struct aiMaterial;
struct aiScene;

namespace limpid {

// A material as the vertices and the part of a model take it.
struct AssimpMaterial {
  Finish finish;
  Eigen::Vector3f color = Vertex{}.color;  // linear
  float opacity = 1;
  bool plain = true;  // the file says nothing about it
};

class AssimpMaterials {
 public:
  // Keeps references to all; they must outlive this.
  AssimpMaterials(const aiScene& scene, const ModelKind& kind, AssimpFiles& files)
      : scene_(scene), kind_(kind), files_(files) {}

  const AssimpMaterial& at(unsigned index);
  // Returns the pictures, still encoded; Finish::color is a number in this list.
  const std::vector<std::vector<unsigned char>>& pictures() const { return pictures_; }

 private:
  AssimpMaterial read(const aiMaterial& from);
  int picture(const std::string& file);

  const aiScene& scene_;
  const ModelKind& kind_;
  AssimpFiles& files_;
  std::map<unsigned, AssimpMaterial> known_;
  std::map<std::string, int> numbers_;  // of pictures, by their files
  std::vector<std::vector<unsigned char>> pictures_;
};

// A model that assimp read. Assimp trusts files in places, so only a program of its own does this:
// limpid-model.
struct AssimpModel {
  Model model;                                       // without images
  std::vector<std::vector<unsigned char>> pictures;  // encoded; Finish::color is a number in it
  bool outside = false;                              // other files were read, too
};

// Reads a file as this kind only. Coordinates are those of the file; Collada's are in metres, its
// up axis is not turned. `progress` is called with 0 to 1. `files` has the model and goes to
// assimp. Throws std::runtime_error with one line.
AssimpModel read_with_assimp(AssimpFiles* files, const ModelKind& kind,
                             const std::function<void(double)>& progress);

}  // namespace limpid
