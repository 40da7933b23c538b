#include "hydrodip/workspace.h"

#include <map>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "artwork/artwork.h"
#include "base/file.h"
#include "base/run_scope.h"
#include "object/simplify.h"
#include "session/content_key.h"
#include "session/node_store.h"

namespace hydrodip {
namespace {

DesignOptions at(Quality quality, const DesignOptions& design) {
  return quality == Quality::kDraft ? draft_of(design) : design;
}

// ---- sizes ----

template <class Item>
std::size_t bytes_of(const std::vector<Item>& list) {
  return list.size() * sizeof(Item);
}

template <class Item>
std::size_t bytes_of(const BlankArray<Item>& list) {
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
  std::vector<LaidLayer> laid = {};
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

  struct Loaded {
    Model model;
    std::string content;  // of its files
  };

  // Loads, and remembers what was in the files. Once more if they changed meanwhile.
  Loaded read(const Project& project, const std::string& asked, const RunContext& context) {
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
      return {std::move(model), content.text()};
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
    const auto key_of = [&](const std::string& content) {
      ContentKey key("model");
      key.add(content);
      add(key, project.load);
      return key;
    };
    if (const std::optional<std::string> content = content_of(asked.text())) {
      ContentKey key = key_of(*content);
      if (auto known = nodes.known<Model>(key)) return {std::move(key), std::move(known)};
    }
    // By what was loaded, not by what was there before: files change, and other threads read too.
    Loaded fresh = read(project, asked.text(), context);
    return node<Model>(key_of(fresh.content), context, [&] { return std::move(fresh.model); });
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
      const RunScope scope(context);
      Artwork artwork = lay_artwork(
          {project.artwork, read_pictures(project.artwork), paint_of(*loaded.value, project.base),
           loaded.value->health.closed(), options.dpi, options.inverse.samples_per_axis},
          *hanging.value, context);
      return SharedPaint{std::move(artwork.paint), std::move(artwork.layers)};
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

std::vector<LaidLayer> Workspace::laid(const Project& project, Quality quality,
                                       const RunContext& context) {
  return impl_->paint(project, quality, context).value->laid;
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
