#include "session/content_key.h"

#include <fmt/format.h>

#include <bit>
#include <memory>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "elastic/linear_solver.h"
#include "ink/color_model.h"

namespace hydrodip {

ContentKey& ContentKey::add(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value + 0.0);  // -0 is 0
  for (int byte = 0; byte < 8; ++byte) text_ += char((bits >> (8 * byte)) & 0xff);
  return *this;
}

ContentKey& ContentKey::add(const std::string& text) {
  add(double(text.size()));
  text_ += text;
  return *this;
}

// What a key leaves out of options gives stale values. So each of these functions takes all members
// by name: one that is new does not compile until it is here as well.

namespace {

template <class... Values>
void add_all(ContentKey& key, const Values&... values) {
  (key.add(values), ...);
}

void add(ContentKey& key, const Vec3& v) { add_all(key, v.x(), v.y(), v.z()); }

void add(ContentKey& key, const FilmCorrection& correction) {
  const auto& [first, pitch_mm, nx, ny, move] = correction;
  add_all(key, first.x(), first.y(), pitch_mm, nx, ny);
  for (const Vec2& m : move) add_all(key, m.x(), m.y());
}

void add(ContentKey& key, const Keyframe& keyframe) {
  const auto& [lower_mm, shift_x_mm, shift_y_mm, turn_x_deg, turn_y_deg, turn_z_deg] = keyframe;
  add_all(key, lower_mm, shift_x_mm, shift_y_mm, turn_x_deg, turn_y_deg, turn_z_deg);
}

void add(ContentKey& key, const std::vector<double>& numbers) {
  key.add(double(numbers.size()));
  for (const double number : numbers) key.add(number);
}

// A law of its own is refused.
void add(ContentKey& key, const FilmMaterial& material) {
  const auto& [z_stretch, poisson, tear_stretch, safe_stretch, lost_stretch, wrinkle_stretch, law] =
      material;
  add_all(key, z_stretch, poisson, tear_stretch, safe_stretch, lost_stretch, wrinkle_stretch);
}

// Of a file that is not there, too.
void add_state(ContentKey& key, const std::filesystem::path& file) {
  const FileState state = state_of(file);
  key.add(file.string()).add(state.bytes);
  key.add(double(state.changed.time_since_epoch().count()));
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

}  // namespace

FileState state_of(const std::filesystem::path& path) {
  std::error_code none;
  return {path, std::filesystem::file_size(path, none),
          std::filesystem::last_write_time(path, none)};
}

void add(ContentKey& key, const LoadOptions& load) {
  const auto& [units, texture, confined_to] = load;
  add_all(key, units, texture.string(), confined_to.string());
}

void add(ContentKey& key, const PoseOptions& pose) {
  const auto& [size_mm, down, rotate_deg] = pose;
  add_all(key, size_mm, down);
  add(key, rotate_deg);
}

void add(ContentKey& key, const FilmOptions& film) {
  const auto& [width_mm, height_mm, shape, margin_mm, elements, grading, swelling_x, swelling_y,
               correction] = film;
  add_all(key, width_mm, height_mm, shape, margin_mm, elements, grading, swelling_x, swelling_y);
  key.add(correction ? "corrected" : "as printed");
  if (correction) add(key, *correction);
}

void add(ContentKey& key, const TrajectoryOptions& way) {
  const auto& [depth_mm, path, tilt_deg, tilt_toward_deg, roll_deg, pivot_mm] = way;
  add_all(key, depth_mm, tilt_deg, tilt_toward_deg, roll_deg);
  add(key, pivot_mm);
  key.add(int(path.size()));
  for (const Keyframe& k : path) add(key, k);
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

void add(ContentKey& key, const PrinterOptions& printer) {
  const auto& [model, profile, intent, color] = printer;
  add_all(key, model, intent, color);
  const bool is_installed = profile.empty() && model == InkModel::kProfile;
  add_state(key, is_installed ? installed_cmyk_profile() : profile);
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

}  // namespace hydrodip
