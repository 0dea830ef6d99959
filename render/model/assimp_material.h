// Materials as assimp has them, with the pictures they use.
#pragma once

#include <map>
#include <string>

#include "render/model/assimp_files.h"
#include "render/model/model.h"
#include "render/model/model_images.h"

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
  // Pictures are added to model.images. All of these outlive this.
  AssimpMaterials(const aiScene& scene, const std::string& kind, const std::string& name,
                  AssimpFiles& files, Model& model)
      : scene_(scene), kind_(kind), name_(name), files_(files), model_(model) {}

  // Decodes the pictures of a material that is new.
  const AssimpMaterial& at(unsigned index);

 private:
  AssimpMaterial read(const aiMaterial& from);
  int picture(const std::string& file);

  const aiScene& scene_;
  const std::string& kind_;
  const std::string& name_;
  AssimpFiles& files_;
  Model& model_;
  ModelImages images_;
  std::map<unsigned, AssimpMaterial> known_;
  std::map<std::string, int> pictures_;
};

}  // namespace limpid
