#include "hydrodip/workspace.h"

#include <fmt/format.h>

#include <map>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/run_scope.h"
#include "elastic/linear_solver.h"
#include "ink/color_model.h"
#include "object/simplify.h"
#include "session/node_store.h"

namespace hydrodip {
namespace {

// ---- keys ----

// A file as the file system tells it apart from a changed one.
struct FileState {
  std::filesystem::path path;
  std::uintmax_t bytes = 0;
  std::filesystem::file_time_type changed;
  bool operator==(const FileState&) const = default;
};

FileState state_of(const std::filesystem::path& path) {
  std::error_code none;
  return {path, std::filesystem::file_size(path, none),
          std::filesystem::last_write_time(path, none)};
}

// What a key leaves out of options gives stale values. So each of these functions takes all members
// by name: one that is new does not compile until it is here as well.

template <class... Values>
void add_all(ContentKey& key, const Values&... values) {
  (key.add(values), ...);
}

void add(ContentKey& key, const Vec3& v) { add_all(key, v.x(), v.y(), v.z()); }

void add(ContentKey& key, const LoadOptions& load) {
  const auto& [units, texture, confined_to] = load;
  add_all(key, units, texture.string(), confined_to.string());
}

void add(ContentKey& key, const PoseOptions& pose) {
  const auto& [size_mm, down, rotate_deg] = pose;
  add_all(key, size_mm, down);
  add(key, rotate_deg);
}

void add(ContentKey& key, const FilmCorrection& correction) {
  const auto& [first, pitch_mm, nx, ny, move] = correction;
  add_all(key, first.x(), first.y(), pitch_mm, nx, ny);
  for (const Vec2& m : move) add_all(key, m.x(), m.y());
}

void add(ContentKey& key, const FilmOptions& film) {
  const auto& [width_mm, height_mm, shape, margin_mm, elements, grading, swelling_x, swelling_y,
               correction] = film;
  add_all(key, width_mm, height_mm, shape, margin_mm, elements, grading, swelling_x, swelling_y);
  key.add(correction ? "corrected" : "as printed");
  if (correction) add(key, *correction);
}

void add(ContentKey& key, const Keyframe& keyframe) {
  const auto& [lower_mm, shift_x_mm, shift_y_mm, turn_x_deg, turn_y_deg, turn_z_deg] = keyframe;
  add_all(key, lower_mm, shift_x_mm, shift_y_mm, turn_x_deg, turn_y_deg, turn_z_deg);
}

void add(ContentKey& key, const TrajectoryOptions& way) {
  const auto& [depth_mm, path, tilt_deg, tilt_toward_deg, roll_deg, pivot_mm] = way;
  add_all(key, depth_mm, tilt_deg, tilt_toward_deg, roll_deg);
  add(key, pivot_mm);
  key.add(int(path.size()));
  for (const Keyframe& k : path) add(key, k);
}

void add(ContentKey& key, const std::vector<double>& numbers) {
  key.add(double(numbers.size()));
  for (const double number : numbers) key.add(number);
}

bool is_multigrid(const DipOptions& dip) {
  const auto* made_by = dip.make_solver.target<decltype(&make_multigrid_solver)>();
  return made_by && *made_by == &make_multigrid_solver;
}

// Values are kept by their content, which these do not have: what is behind them is not seen, and
// steps that dips keep for one another change with every dip.
void require_content(const DipOptions& dip) {
  const char* unseen = dip.material.law     ? "film with a material law of its own"
                       : dip.relaxed_steps  ? "steps that dips keep for one another"
                       : !is_multigrid(dip) ? "solver of one's own"
                                            : nullptr;
  if (unseen)
    throw InputError(
        fmt::format("a workspace takes no {}; use the steps of hydrodip/hydrodip.h", unseen));
}

// A law of its own is refused.
void add(ContentKey& key, const FilmMaterial& material) {
  const auto& [z_stretch, poisson, tear_stretch, safe_stretch, lost_stretch, wrinkle_stretch, law] =
      material;
  add_all(key, z_stretch, poisson, tear_stretch, safe_stretch, lost_stretch, wrinkle_stretch);
}

// asks_what_moves is not looked at: a dip with its air decides that by itself (dip_object()).
void add(ContentKey& key, const DipOptions& dip) {
  require_content(dip);
  const auto& [step_mm, even_steps, steps_at_mm, relaxed_steps, method, scheme, material, modulus,
               make_solver, tears_at_mm, asks_what_moves, quick_look, moved_mm, failed_share_max] =
      dip;
  add_all(key, step_mm, even_steps, method, scheme, quick_look, failed_share_max);
  add(key, material);
  for (const auto* numbers : {&steps_at_mm, &modulus, &tears_at_mm, &moved_mm}) add(key, *numbers);
}

void add(ContentKey& key, const LinearColor& color) {
  const auto& [r, g, b, a] = color;
  add_all(key, double(r), double(g), double(b), double(a));
}

// Of a file that is not there, too.
void add_state(ContentKey& key, const std::filesystem::path& file) {
  const FileState state = state_of(file);
  key.add(file.string()).add(state.bytes);
  key.add(double(state.changed.time_since_epoch().count()));
}

void add(ContentKey& key, const PrinterOptions& printer) {
  const auto& [model, profile, intent, color] = printer;
  add_all(key, model, intent, color);
  const bool is_installed = profile.empty() && model == InkModel::kProfile;
  add_state(key, is_installed ? installed_cmyk_profile() : profile);
}

void add(ContentKey& key, const InverseOptions& inverse) {
  const auto& [bleed_mm, samples_per_axis, quick_look] = inverse;
  add_all(key, bleed_mm, samples_per_axis, quick_look);
}

// The base is the paint's.
void add(ContentKey& key, const InkingOptions& inking) {
  const auto& [compensate, policy, limit, lightened_most, base] = inking;
  add_all(key, compensate, policy, limit, lightened_most);
}

void add(ContentKey& key, const StiffnessOptions& stiffness) {
  const auto& [ratio, filter_mm] = stiffness;
  add_all(key, ratio, filter_mm);
}

void add(ContentKey& key, const DesignOptions& design) {
  const auto& [film, trajectory, dip, air, stiffness, rounds_max, settled_mm, rounds_step_mm, dpi,
               inverse, inking] = design;
  add(key, film);
  add(key, trajectory);
  add(key, dip);
  const auto& [cells] = air;
  key.add(cells);
  add(key, stiffness);
  add_all(key, rounds_max, settled_mm, rounds_step_mm, dpi);
  add(key, inverse);
  add(key, inking);
}

void add(ContentKey& key, const std::optional<Vec3>& v) {
  key.add(v ? "set" : "open");
  if (v) add(key, *v);
}

// A picture at hand is known by its pixels: where they lie in memory, others may lie the next time.
void add(ContentKey& key, const std::shared_ptr<const Image>& picture) {
  key.add(picture ? "at hand" : "none");
  if (!picture) return;
  key.add(picture->width_px).add(picture->height_px).add(sha256_hex(picture->rgba));
}

void add(ContentKey& key, const ArtworkLayer& layer) {
  const auto& [image, picture, text, font, text_color, projection, at_mm, toward, up, width_mm,
               height_mm, turn_deg, repeat, through, fade_deg, opacity, blend] = layer;
  add_state(key, image);
  add(key, picture);
  add_all(key, text, font);
  add(key, text_color);
  add_all(key, projection, repeat, blend, through);
  for (const auto* v : {&at_mm, &toward, &up}) add(key, *v);
  add_all(key, width_mm, height_mm, turn_deg, fade_deg, opacity);
}

DesignOptions at(Quality quality, const DesignOptions& design) {
  return quality == Quality::kDraft ? draft_of(design) : design;
}

// ---- sizes ----

template <class Item>
std::size_t bytes_of(const std::vector<Item>& list) {
  return list.size() * sizeof(Item);
}

std::size_t bytes_of(const Image& image) { return bytes_of(image.rgba); }

std::size_t bytes_of(const Model& model) {
  const Object& o = *model.object;
  std::size_t bytes = bytes_of(o.positions) + bytes_of(o.triangles) + bytes_of(o.material_of) +
                      bytes_of(o.uvs) + bytes_of(o.colors);
  for (const auto& texture : o.textures) bytes += bytes_of(*texture);
  return bytes;
}

// A mesh with the tree in which rays find its triangles.
std::size_t bytes_with_tree(std::size_t positions, std::size_t triangles) {
  constexpr std::size_t kTreePerTriangle = 128;
  return positions * sizeof(Vec3) + triangles * (sizeof(Triangle) + kTreePerTriangle);
}

std::size_t bytes_of(const PosedObject& posed) {
  return bytes_with_tree(posed.mesh().positions.size(), posed.mesh().triangles.size());
}

std::size_t bytes_of(const DippedObject& dipped) {
  const std::size_t vertices = dipped.film->position.size();
  const std::size_t triangles = dipped.film->mesh().triangles.size();
  std::size_t bytes = 2 * bytes_with_tree(vertices, triangles);
  for (const DipFrame& frame : dipped.history->frames()) bytes += bytes_of(frame.position);
  return bytes;
}

std::size_t bytes_of(const Designed& made) {
  const FilmInk& ink = made.ink.ink;
  return bytes_of(made.dipped) + bytes_of(ink.wanted) + bytes_of(ink.on_object) +
         bytes_of(ink.inking.inks.cmyk) + ink.inking.printed.bytes() +
         bytes_of(ink.stretch.area_ratio) + bytes_of(ink.stretch.on_object) +
         bytes_of(made.ink.reach.out_of_reach);
}

struct SharedPaint {
  std::shared_ptr<const Paint> paint;
};

// Its pictures are not known here; a guess.
std::size_t bytes_of(const SharedPaint&) { return std::size_t(16) << 20U; }

}  // namespace

struct Workspace::Impl {
  explicit Impl(std::size_t memory_bytes) : nodes(memory_bytes) {}

  // What a model's files were when it was read, and what was in them.
  struct Reading {
    std::vector<FileState> files;
    std::string content;
  };

  // What is in the files that were read for this; nothing if they have changed or never were.
  std::optional<std::string> content_of(const std::string& asked) {
    const std::lock_guard lock(mutex);
    const auto known = readings.find(asked);
    if (known == readings.end()) return std::nullopt;
    for (const FileState& file : known->second.files)
      if (state_of(file.path) != file) return std::nullopt;
    return known->second.content;
  }

  // Loads, and remembers what was in the files. Once more if they changed meanwhile.
  Model read(const Project& project, const std::string& asked, const RunContext& context) {
    constexpr int kTries = 3;
    for (int left = kTries;; --left) {
      const auto begun = std::filesystem::file_time_type::clock::now();
      Model model = load(project.model, project.load, context);
      Reading reading;
      ContentKey content("content");
      bool calm = true;
      for (const std::filesystem::path& file : model.files) {
        reading.files.push_back(state_of(file));
        calm &= reading.files.back().changed < begun;
        content.add(sha256_hex(read_file(file)));
      }
      if (!calm && left > 0) continue;
      reading.content = content.text();
      const std::lock_guard lock(mutex);
      readings[asked] = std::move(reading);
      return model;
    }
  }

  template <class Value>
  struct Keyed {
    ContentKey key;
    std::shared_ptr<const Value> value;
  };

  template <class Value, class Make>
  Keyed<Value> node(ContentKey key, const RunContext& context, const Make& make) {
    auto value =
        nodes.get<Value>(key, context, make, [](const Value& made) { return bytes_of(made); });
    return {std::move(key), std::move(value)};
  }

  Keyed<Model> model(const Project& project, const RunContext& context) {
    ContentKey asked("asked");
    asked.add(project.model.string());
    add(asked, project.load);
    std::optional<Model> fresh;
    std::optional<std::string> content = content_of(asked.text());
    if (!content) {
      fresh = read(project, asked.text(), context);
      const std::lock_guard lock(mutex);
      content = readings[asked.text()].content;
    }
    ContentKey key("model");
    key.add(*content);
    add(key, project.load);
    return node<Model>(std::move(key), context,
                       [&] { return fresh ? *fresh : load(project.model, project.load, context); });
  }

  // As the project looks at it.
  Keyed<Model> looked_at(const Project& project, const RunContext& context) {
    auto loaded = model(project, context);
    const std::size_t most = project.most_triangles;
    if (most == 0 || loaded.value->object->triangles.size() <= most) return loaded;
    ContentKey key("simplified");
    key.add(loaded.key.text()).add(double(most));
    return node<Model>(std::move(key), context, [&] {
      const RunScope scope(context);
      Model coarse = *loaded.value;
      coarse.object = std::make_shared<const Object>(simplified(*loaded.value->object, most));
      return coarse;
    });
  }

  Keyed<PosedObject> posed(const Project& project, const RunContext& context) {
    const auto loaded = looked_at(project, context);
    ContentKey key("posed");
    key.add(loaded.key.text());
    add(key, project.pose);
    return node<PosedObject>(std::move(key), context, [&] {
      const RunScope scope(context);
      return pose(*loaded.value, project.pose);
    });
  }

  Keyed<DippedObject> dipped(const Project& project, Quality quality, const RunContext& context) {
    const auto hanging = posed(project, context);
    const DesignOptions options = at(quality, project.design);
    ContentKey key("dipped");
    key.add(hanging.key.text());
    add(key, options.film);
    add(key, options.trajectory);
    add(key, options.dip);
    key.add(options.air.cells);
    return node<DippedObject>(std::move(key), context, [&] {
      return simulate(*hanging.value, {options.film, options.trajectory, options.dip, options.air},
                      context);
    });
  }

  Keyed<SharedPaint> paint(const Project& project, Quality quality, const RunContext& context) {
    const auto loaded = looked_at(project, context);
    const auto hanging = posed(project, context);
    const DesignOptions options = at(quality, project.design);
    ContentKey key("paint");
    key.add(hanging.key.text());
    add(key, project.base);
    key.add(options.dpi).add(options.inverse.samples_per_axis);
    if (project.artwork.empty())
      return {std::move(key), std::make_shared<const SharedPaint>(
                                  SharedPaint{paint_of(*loaded.value, project.base)})};
    for (const ArtworkLayer& layer : project.artwork) add(key, layer);
    return node<SharedPaint>(std::move(key), context, [&] {
      return SharedPaint{paint_with(*loaded.value, *hanging.value, project.artwork, project.base,
                                    options.dpi, options.inverse.samples_per_axis, context)};
    });
  }

  Keyed<Designed> designed(const Project& project, Quality quality, const RunContext& context) {
    const auto hanging = posed(project, context);
    const auto wanted = paint(project, quality, context);
    const DesignOptions options = at(quality, project.design);
    ContentKey key("designed");
    key.add(wanted.key.text());
    add(key, options);
    add(key, project.printer);
    // Ink that does not stiffen the film changes nothing of the dip: another picture needs none.
    if (options.rounds_max == 1) {
      const auto blank = dipped(project, quality, context);
      return node<Designed>(std::move(key), context, [&] {
        const Printer printer = make_printer(project.printer);
        const Allotment all;
        return design_on({*hanging.value, *wanted.value->paint, all, *printer.model, options},
                         *blank.value, context);
      });
    }
    return node<Designed>(std::move(key), context, [&] {
      return design(*hanging.value, *wanted.value->paint, options, make_printer(project.printer),
                    context);
    });
  }

  Keyed<Image> picture(const Project& project, Quality quality, int width_px,
                       const RunContext& context) {
    const auto made = designed(project, quality, context);
    ContentKey key("picture");
    key.add(made.key.text()).add(width_px);
    const auto wanted = paint(project, quality, context);
    return node<Image>(std::move(key), context, [&] {
      return render(finish(wanted.value->paint, {*made.value}), width_px, context);
    });
  }

  NodeStore nodes;
  std::mutex mutex;
  std::map<std::string, Reading> readings;
  std::optional<RunContext> newest;
};

Workspace::Workspace(std::size_t memory_bytes) : impl_(std::make_unique<Impl>(memory_bytes)) {}
Workspace::~Workspace() = default;

RunContext Workspace::newest() {
  RunContext next;
  const std::lock_guard lock(impl_->mutex);
  if (impl_->newest) impl_->newest->cancel();
  impl_->newest = next;
  return next;
}

std::shared_ptr<const Model> Workspace::model(const Project& project, const RunContext& context) {
  return impl_->looked_at(project, context).value;
}

std::shared_ptr<const PosedObject> Workspace::posed(const Project& project,
                                                    const RunContext& context) {
  return impl_->posed(project, context).value;
}

std::shared_ptr<const Paint> Workspace::paint(const Project& project, Quality quality,
                                              const RunContext& context) {
  return impl_->paint(project, quality, context).value->paint;
}

std::shared_ptr<const DippedObject> Workspace::dipped(const Project& project, Quality quality,
                                                      const RunContext& context) {
  return impl_->dipped(project, quality, context).value;
}

std::shared_ptr<const Designed> Workspace::designed(const Project& project, Quality quality,
                                                    const RunContext& context) {
  return impl_->designed(project, quality, context).value;
}

std::shared_ptr<const Image> Workspace::picture(const Project& project, Quality quality,
                                                int width_px, const RunContext& context) {
  return impl_->picture(project, quality, width_px, context).value;
}

std::size_t Workspace::memory_bytes() const { return impl_->nodes.bytes(); }
std::size_t Workspace::computed() const { return impl_->nodes.computed(); }

}  // namespace hydrodip
