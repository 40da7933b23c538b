#include "calibrate/subject.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/error.h"
#include "base/file.h"
#include "samples/samples.h"

namespace hydrodip {
namespace {

// A corner this far off the surface is no corner on it.
constexpr double kReach_mm = 2;
// Scanners are good to tenths of a millimetre.
constexpr double kSuspiciousDistance_mm = 0.3;
constexpr double kLargestDistance_mm = 0.7;
// To find out how a scan lies, this is good enough.
constexpr int kCoarseElements = 10000;
constexpr double kCoarseStep_mm = 0.25;

struct SubjectText {
  std::string object;
  std::string file;
};

SubjectText split(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals != std::string::npos && equals > 0 && equals + 1 < text.size())
    return {text.substr(0, equals), text.substr(equals + 1)};
  const std::string stem = std::filesystem::path(text).stem().string();
  for (const KitShape& shape : kit_shapes())
    if (stem.find(shape.name) != std::string::npos) return {shape.name, text};
  throw InputError(fmt::format(
      "{}: say which object was scanned, as in 'sphere={}', 'ellipsoid@11=...' (dipped 11 mm deep) "
      "or 'model.stl@20=...'",
      text, text));
}

GridPlace reach_of(const FilmOptions& film, double square_mm) {
  return {int(0.5 * film.width_mm / square_mm), int(0.5 * film.height_mm / square_mm)};
}

// Warns, or refuses what cannot be a scan of this object.
void judge(const Subject& subject, const Alignment& alignment, bool aligned,
           const RunContext& context) {
  const std::string file = subject.file.string();
  if (alignment.rms_mm > kLargestDistance_mm)
    throw InputError(
        fmt::format("{}: the corners lie {:.1f} mm off the {}'s surface (root mean square); {}",
                    file, alignment.rms_mm, subject.object.name,
                    aligned ? "leave out --aligned to have the scan registered"
                            : "check which object was scanned and its unit"));
  if (alignment.rms_mm > kSuspiciousDistance_mm || alignment.worst_mm > kReach_mm)
    context.warn(fmt::format(
        "{}: corners lie {:.2f} mm off the {}'s surface (root mean square, worst {:.2f} mm): check "
        "the scan, and that the object was made to size.",
        file, alignment.rms_mm, subject.object.name, alignment.worst_mm));
}

void judge_match(const Subject& subject, const GridMatch& match, bool told_mirrored,
                 const RunContext& context) {
  const std::string file = subject.file.string();
  if (match.mirrored)
    throw InputError(
        fmt::format("{}: the scan is a mirror image of the {}; {}", file, subject.object.name,
                    told_mirrored ? "leave out --mirrored" : "export it anew, or give --mirrored"));
  if (match.turned)
    context.warn(fmt::format(
        "{}: rows and columns run the wrong way round: its faces look into the object, or it is a "
        "mirror image. The {} is its own mirror image, so the result does not depend on it.",
        file, subject.object.name));
}

void find_how_it_lies(Subject& subject, const ScanSettings& settings, const JobConfig& config,
                      const RunContext& context) {
  const TriangleMesh& object = subject.object.object;
  subject.surface = std::make_unique<Surface>(object.positions, object.triangles);
  if (settings.aligned) {
    judge(subject, as_it_lies(subject.scan.grid, *subject.surface), true, context);
    return;
  }
  DesignOptions coarse = config.design;
  coarse.film.elements = std::min(config.design.film.elements, kCoarseElements);
  coarse.dip.step_mm = std::max(config.design.dip.step_mm, kCoarseStep_mm);
  coarse.dip.method = DipMethod::kFull;
  const double square_mm = settings.file.square_mm;
  RunContext quiet = context.quiet();
  const CheckerboardDip dip =
      dip_checkerboard(checkered_film(coarse, square_mm), subject.object, *subject.surface,
                       film_parameters(config.design), coarse.dip, quiet);
  const GridLanding landing = dip.landing(subject.object);
  GridMatch match = match_grid(subject.scan.grid, landing, reach_of(config.design.film, square_mm),
                               square_mm, subject.file.string());
  judge_match(subject, match, settings.file.mirrored, context);
  const Alignment alignment = align(subject.scan.grid, match, *subject.surface, landing);
  judge(subject, alignment, false, context);
  match.pose = alignment.pose;
  subject.match = match;
}

// Bytes that identify numbers.
class Fingerprint {
 public:
  void add(double value) {
    std::uint8_t bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    bytes_.insert(bytes_.end(), bytes, bytes + sizeof value);
  }
  std::string text() const { return sha256_hex(bytes_).substr(0, 16); }

 private:
  std::vector<std::uint8_t> bytes_;
};

// What this program makes of a small dip: another mesh, solver or scheme makes something else, and
// what an older program has simulated is no use to it then.
double program_mark(const RunContext& context) {
  DesignOptions small;
  small.film.width_mm = small.film.height_mm = 120;
  small.film.elements = 800;
  small.dip.step_mm = 1;
  CalibrationObject object;
  object.object = make_sample("pyramid");
  object.depth_mm = 4;
  const Surface surface(object.object.positions, object.object.triangles);
  const CheckerboardDip dip = dip_checkerboard(checkered_film(small, 5), object, surface,
                                               film_parameters(small), small.dip, context);
  double sum = 0;
  for (std::size_t v = 0; v < dip.film->position.size(); ++v)
    sum += double(v % 7 + 1) * (dip.film->position[v] - Vec3(0.3, 0.7, 0.1)).squaredNorm();
  return sum;
}

std::string fingerprint_of(const Subject& subject, const ScanSettings& settings,
                           const DesignOptions& design, double program) {
  Fingerprint print;
  print.add(program);
  for (const Vec3& p : subject.scan.grid.position)
    for (int k = 0; k < 3; ++k) print.add(p[k]);
  for (std::size_t c = 0; c < subject.scan.grid.place.size(); ++c)
    for (const int value :
         {subject.scan.grid.place[c][0], subject.scan.grid.place[c][1], subject.scan.grid.patch[c]})
      print.add(value);
  for (const Vec3& p : subject.object.object.positions)
    for (int k = 0; k < 3; ++k) print.add(p[k]);
  for (const double value :
       {subject.object.depth_mm, settings.file.square_mm, double(settings.aligned),
        design.film.width_mm, design.film.height_mm, design.film.margin_mm,
        double(design.film.elements), design.film.grading, double(design.film.shape),
        design.dip.step_mm, double(design.dip.scheme), design.stiffness.filter_mm})
    print.add(value);
  // The search begins to look for the pose where the given parameters laid it.
  if (subject.match)
    for (int i = 0; i < 12; ++i) print.add(subject.match->pose.matrix()(i % 3, i / 3));
  return print.text();
}

void number_namesakes(std::vector<Subject>& subjects) {
  for (std::size_t i = 0; i < subjects.size(); ++i) {
    const std::string name = subjects[i].object.name;
    const auto same = [&](const Subject& other) { return other.object.name == name; };
    subjects[i].name = name;
    if (std::count_if(subjects.begin(), subjects.end(), same) < 2) continue;
    const auto before = std::count_if(subjects.begin(), subjects.begin() + std::ptrdiff_t(i), same);
    subjects[i].name = fmt::format("{}-{}", name, before + 1);
  }
}

// Film coordinates by scan coordinates, per corner: how an error of the scan shows on the film.
using WarpGradient = Eigen::Matrix<double, 2, 3>;
std::vector<std::optional<WarpGradient>> warp_gradients(const Subject& subject,
                                                        const CheckerboardDip& dip,
                                                        const Eigen::Isometry3d& pose) {
  constexpr double kShift_mm = 0.25;  // about as far as a cell of the film
  std::vector<std::optional<WarpGradient>> gradients(subject.scan.grid.position.size(),
                                                     WarpGradient(WarpGradient::Zero()));
  for (int axis = 0; axis < 3; ++axis) {
    std::array<WarpedGrid, 2> sides;
    for (const int side : {0, 1}) {
      Eigen::Isometry3d shifted = pose;
      shifted.pretranslate((side == 0 ? -kShift_mm : kShift_mm) * Vec3::Unit(axis));
      sides[std::size_t(side)] =
          warp(moved(subject.scan.grid, shifted), *subject.surface, *dip.map, kReach_mm);
    }
    for (std::size_t c = 0; c < gradients.size(); ++c) {
      if (!sides[0][c] || !sides[1][c]) gradients[c].reset();
      if (gradients[c]) gradients[c]->col(axis) = (*sides[1][c] - *sides[0][c]) / (2 * kShift_mm);
    }
  }
  return gradients;
}

}  // namespace

Comparison compare(const Subject& subject, const CheckerboardDip& dip) {
  Comparison result;
  CornerGrid grid = subject.scan.grid;
  if (subject.match) {
    result.alignment = align(grid, *subject.match, *subject.surface, dip.landing(subject.object));
    grid = moved(grid, result.alignment.pose);
  } else {
    result.alignment = as_it_lies(grid, *subject.surface);
  }
  result.warped = warp(grid, *subject.surface, *dip.map, kReach_mm);
  return result;
}

std::vector<double> errors_by_length(const Subject& subject,
                                     const std::optional<WarpedGrid>& warped, double square_mm) {
  std::vector<double> errors(subject.lengths.size(), std::numeric_limits<double>::quiet_NaN());
  if (!warped || warped->size() != subject.scan.grid.position.size()) return errors;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const std::vector<LengthError> one = length_errors({subject.lengths[i]}, *warped, square_mm);
    if (!one.empty()) errors[i] = one.front().error_mm;
  }
  return errors;
}

Eigen::MatrixXd noise_gradient_of(const Subject& subject, const CheckerboardDip& dip,
                                  const Comparison& comparison) {
  const auto corners = warp_gradients(subject, dip, comparison.alignment.pose);
  Eigen::MatrixXd gradient = Eigen::MatrixXd::Zero(
      Eigen::Index(subject.lengths.size()), 3 * Eigen::Index(subject.scan.grid.position.size()));
  for (std::size_t i = 0; i < subject.lengths.size(); ++i) {
    const auto from = std::size_t(subject.lengths[i].from);
    const auto to = std::size_t(subject.lengths[i].to);
    const auto &a = comparison.warped[from], &b = comparison.warped[to];
    if (!a || !b) continue;
    const Vec2 along = (*b - *a).normalized();
    const auto row = Eigen::Index(i);
    if (corners[from])
      gradient.block<1, 3>(row, 3 * Eigen::Index(from)) = -along.transpose() * *corners[from];
    if (corners[to])
      gradient.block<1, 3>(row, 3 * Eigen::Index(to)) = along.transpose() * *corners[to];
  }
  return gradient;
}

std::vector<Subject> load_subjects(const std::vector<std::string>& texts,
                                   const ScanSettings& settings, const JobConfig& config,
                                   const RunContext& context) {
  RunContext quiet = context.quiet();
  const double program = program_mark(quiet);
  std::vector<Subject> subjects;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    context.progress("reading scans", double(i) / double(texts.size()));
    const SubjectText text = split(texts[i]);
    Subject subject;
    subject.file = text.file;
    subject.scan = read_scan(text.file, settings.file);
    subject.object = calibration_object(text.object, config, context);
    subject.lengths = grid_lengths(subject.scan.grid);
    find_how_it_lies(subject, settings, config, context);
    subject.fingerprint = fingerprint_of(subject, settings, config.design, program);
    subjects.push_back(std::move(subject));
  }
  number_namesakes(subjects);
  context.progress("reading scans", 1);
  return subjects;
}

bool any_synthetic(const std::vector<Subject>& subjects) {
  return std::any_of(subjects.begin(), subjects.end(),
                     [](const Subject& subject) { return subject.scan.synthetic; });
}

std::vector<std::filesystem::path> files_of(const std::vector<Subject>& subjects) {
  std::vector<std::filesystem::path> files;
  for (const Subject& subject : subjects) files.push_back(subject.file);
  return files;
}

}  // namespace hydrodip
