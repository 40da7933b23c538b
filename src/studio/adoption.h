// What becomes of files that were dropped together: a job, a model, layers of artwork, parts of
// these, or nothing.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "studio/json.h"

namespace hydrodip {

class Adoption {
 public:
  // Names of the job's files.
  explicit Adoption(std::vector<std::string> names);

  const std::vector<std::string>& names() const { return names_; }
  // The job file, to which all others belong; "": there is none.
  const std::string& job() const { return job_; }
  // The model that the job gets; "": none, or a job says which.
  const std::string& model() const { return model_; }

  // That a file, perhaps one of these, belongs to the model.
  void add_part(const std::string& name) { parts_.insert(name); }
  // The model's picture, which its own file does not name; "": none.
  void set_texture(const std::string& name) { texture_ = name; }

  // Puts model and layers in. Of a job file the document is made elsewhere.
  void put_into(Json& document) const;
  // File by file, as the answer of adopt has it.
  Json told() const;

 private:
  std::string first(const std::string& kind) const;
  // "part", "layer", "unused"; "" where nothing is said of it.
  std::string use_of(const std::string& name) const;

  std::vector<std::string> names_;
  std::string job_, model_, texture_;
  std::set<std::string> parts_;
};

}  // namespace hydrodip
