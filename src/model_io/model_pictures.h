// The pictures that a model shows: each read and decoded once, beside each other and beside what
// else is done to the model.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "base/begun.h"
#include "image/image.h"
#include "model_io/model_folder.h"

namespace hydrodip {

class ModelPictures : public ExpectedPictures {
 public:
  // `model`: its path, for messages. `folder` and `context` must outlive it.
  ModelPictures(std::string model, ModelFolder& folder, const RunContext& context);

  void expect(const FilePicture& picture, const FileMaterial& material) override;

  // Of the model that is read; FileMaterial::picture is one of them.
  void take_over(std::vector<FilePicture> pictures) { of_model_ = std::move(pictures); }

  // The material's picture as it shows it, by its number among those shown: in the order in which
  // they are asked for first, and the same for the same.
  int show(const FileMaterial& material);
  // Waits for it. take() tells why not.
  bool can_be_had(int number);

  // Once: adds all that can be had to `textures`, and returns by their numbers where each lies
  // there, or -1. Warns of the others, and adds why to `problems`, in their order. Throws
  // InputError if together they are too large.
  std::vector<int> take(std::vector<std::shared_ptr<const Image>>& textures,
                        std::vector<std::string>& problems);

 private:
  // Its file or place in the model, and what becomes of its alpha and its range.
  using Key = std::tuple<std::string, Alpha, float, float, float>;
  struct Shown {
    std::filesystem::path file;  // where it is not embedded
    bool was_read = false;
    std::optional<Begun<Image>> decoded;
    int number = -1;
  };

  Key key_of(const FilePicture& picture, const FileMaterial& material);
  Shown& begun(const FilePicture& picture, const FileMaterial& material);
  void wait_for(std::size_t first, std::size_t end);
  Image take(Shown& shown);
  void tell(const std::string& problem, std::vector<std::string>& problems) const;

  const std::string model_;
  ModelFolder& folder_;
  const RunContext& context_;
  std::vector<FilePicture> of_model_;
  std::map<Key, Shown> pictures_;
  std::vector<Shown*> shown_;  // by number
};

}  // namespace hydrodip
