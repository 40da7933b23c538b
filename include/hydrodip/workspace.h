// A project that is looked at while it is being changed: every step's value is kept by the content
// that it was made from, and only what a change touches is computed again.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "artwork/laid_layer.h"
#include "hydrodip/hydrodip.h"

namespace hydrodip {

// A draft is made on coarse film in long steps and without rounds of ink (draft_of()): a small part
// of the time. No dip begins where another pose's dip ended: a value depends on its project alone.
enum class Quality { kDraft, kNormal };

// What a person works on. Values are kept by its content, so that a dip's material law, solver or
// relaxed steps of one's own are refused (InputError).
struct Project {
  std::filesystem::path model;        // its file
  LoadOptions load;                   // how that is read
  PoseOptions pose;                   // how the object hangs over the bath
  LinearColor base{1, 1, 1, 1};       // of the bare object
  std::vector<ArtworkLayer> artwork;  // over the model's colours, the bottom layer first
  DesignOptions design;               // film, way into the water, ink
  PrinterOptions printer;             // which inks it makes of a colour
  // A model of more triangles is looked at with about so many; 0: with all that it has.
  std::size_t most_triangles = 0;
};

// For any number of threads.
class Workspace {
 public:
  // Keeps at most so much in memory, nearly, besides what its callers hold.
  explicit Workspace(std::size_t memory_bytes = std::size_t(1) << 30U);
  ~Workspace();
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  // A context for a request that makes all earlier ones pointless: they are cancelled and throw
  // Cancelled wherever they are.
  RunContext newest();

  // Steps of the project. A model file (with its pictures) that has changed is read again.
  std::shared_ptr<const Model> model(const Project& project, const RunContext& context);
  // As the object hangs over the bath.
  std::shared_ptr<const PosedObject> posed(const Project& project, const RunContext& context);
  // What is wanted on it: the model's colours under the artwork, whose files are read again when
  // they have changed.
  std::shared_ptr<const Paint> paint(const Project& project, Quality quality,
                                     const RunContext& context);
  // Of each layer of that artwork, the bottom one first.
  std::vector<LaidLayer> laid(const Project& project, Quality quality, const RunContext& context);
  // Of film with even stiffness.
  std::shared_ptr<const DippedObject> dipped(const Project& project, Quality quality,
                                             const RunContext& context);
  // What to print, and the dip of it.
  std::shared_ptr<const Designed> designed(const Project& project, Quality quality,
                                           const RunContext& context);
  // Wanted beside predicted.
  std::shared_ptr<const Image> picture(const Project& project, Quality quality, int width_px,
                                       const RunContext& context);

  // Of all values that are kept, nearly.
  std::size_t memory_bytes() const;
  // How many values were computed so far: those asked for again do not count.
  std::size_t computed() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydrodip
