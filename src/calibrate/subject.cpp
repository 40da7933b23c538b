#include "calibrate/subject.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstring>
#include <limits>

#include "base/dense_solvers.h"
#include "base/error.h"
#include "base/file.h"
#include "calibrate/calibrate.h"
#include "calibrate/measured_dip.h"
#include "calibrate/misfit.h"
#include "samples/samples.h"

namespace hydrodip {
namespace {

// A corner this far off the surface is no corner on it.
constexpr double kReach_mm = 2;
// Scanners are good to tenths of a millimetre.
constexpr double kSuspiciousDistance_mm = 0.3;
constexpr double kLargestDistance_mm = 0.7;
// To find out how a scan lies, this is good enough.
constexpr int kCoarseElements = 5000;
constexpr double kCoarseStep_mm = 0.4;

struct SubjectText {
  std::string object;
  std::string file;
};

SubjectText split(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals != std::string::npos && equals > 0 && equals + 1 < text.size())
    return {text.substr(0, equals), text.substr(equals + 1)};
  const std::string stem = std::filesystem::path(text).stem().string();
  for (const KitShape& shape : known_shapes())
    if (stem.find(shape.name) != std::string::npos) return {shape.name, text};
  throw InputError(fmt::format(
      "{}: say which object was scanned, as in 'sphere={}', 'ellipsoid@11=...' (dipped 11 mm deep) "
      "or 'model.stl@20=...'",
      text, text));
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
  subject.place.resize(subject.scan.grid.position.size());
  if (settings.aligned)
    judge(subject, as_it_lies(subject.scan.grid, *subject.surface), true, context);
  DesignOptions coarse = config.design;
  coarse.film.elements = std::min(config.design.film.elements, kCoarseElements);
  coarse.dip.step_mm = std::max(config.design.dip.step_mm, kCoarseStep_mm);
  coarse.dip.method = DipMethod::kFull;
  const Board& board = settings.board;
  RunContext quiet = context.quiet();
  const CheckerboardDip dip =
      dip_checkerboard(checkered_film(coarse, board), subject.object, *subject.surface,
                       film_parameters(config.design), coarse.dip, quiet);
  const GridLanding landing = dip.landing(subject.object);
  const GridPlace reach = reach_of(config.design.film, board.square_mm);
  const auto place_the_rest = [&](const Eigen::Isometry3d& pose, bool turned) {
    place_patches(subject.scan.grid, pose, turned, landing, reach, board.square_mm, subject.place);
  };
  if (settings.aligned) {
    place_the_rest(Eigen::Isometry3d::Identity(), false);
    if (std::none_of(subject.place.begin(), subject.place.end(),
                     [](const auto& place) { return place.has_value(); }))
      throw InputError(fmt::format(
          "{}: {}", subject.file.string(),
          why_unplaced(subject.scan.grid, *subject.surface, landing, reach, board.square_mm)));
    return;
  }
  GridMatch match =
      match_grid(subject.scan.grid, landing, reach, board.square_mm, subject.file.string());
  judge_match(subject, match, settings.file.mirrored, context);
  const Alignment alignment = align(subject.scan.grid, match, *subject.surface, landing);
  judge(subject, alignment, false, context);
  match.pose = alignment.pose;
  subject.place = match.place;
  place_the_rest(match.pose, match.turned);
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
  const CheckerboardDip dip = dip_checkerboard(checkered_film(small, black_board(5)), object,
                                               surface, film_parameters(small), small.dip, context);
  double sum = 0;
  for (std::size_t v = 0; v < dip.film->position.size(); ++v)
    sum += double(v % 7 + 1) * (dip.film->position[v] - Vec3(0.3, 0.7, 0.1)).squaredNorm();
  return sum;
}

std::string fingerprint_of(const CalibrationObject& object, const Board& board,
                           const DesignOptions& design, double program) {
  Fingerprint print;
  print.add(program);
  for (const Vec3& p : object.object.positions)
    for (int k = 0; k < 3; ++k) print.add(p[k]);
  for (const Triangle& t : object.object.triangles)
    for (int k = 0; k < 3; ++k) print.add(double(t[k]));
  for (const double value :
       {object.depth_mm, board.square_mm, double(board.about_square), double(board.period),
        design.film.width_mm, design.film.height_mm, design.film.margin_mm, design.film.swelling_x,
        design.film.swelling_y, double(design.film.elements), design.film.grading,
        double(design.film.shape), design.dip.step_mm, double(design.dip.scheme),
        design.stiffness.filter_mm})
    print.add(value);
  for (const std::uint8_t ink : board.ink) print.add(ink);
  if (design.dip.even_steps) print.add(1);  // what older programs have simulated stays of use
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

// The scan's corners that a dip lays down as well.
struct Pairs {
  std::vector<std::size_t> corner;
  Eigen::Matrix3Xd scanned, landed;
};

Pairs pairs_of(const Subject& subject, const Landings& landings) {
  Pairs pairs;
  for (std::size_t c = 0; c < subject.place.size(); ++c)
    if (subject.place[c] && landings.find(*subject.place[c]) != nullptr) pairs.corner.push_back(c);
  const auto count = Eigen::Index(pairs.corner.size());
  pairs.scanned.resize(3, count);
  pairs.landed.resize(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const std::size_t c = pairs.corner[std::size_t(i)];
    pairs.scanned.col(i) = subject.scan.grid.position[c];
    pairs.landed.col(i) = landings.find(*subject.place[c])->position;
  }
  return pairs;
}

// How much of each open motion is in a misfit. Motions that are nearly the same, as a turn of a
// round object and one of the film under it, share alike.
class OpenAmounts {
 public:
  explicit OpenAmounts(const Eigen::MatrixXd& motions)
      : length_(motions.colwise().norm().cwiseMax(1e-12).transpose()),
        solver_(motions * length_.cwiseInverse().asDiagonal(), kNearlySame) {}
  Eigen::VectorXd of(const Eigen::VectorXd& misfit) const {
    const Eigen::VectorXd amount = solver_.solve(misfit);
    return amount.cwiseQuotient(length_);
  }

 private:
  static constexpr double kNearlySame = 0.02;
  Eigen::VectorXd length_;
  MinimumNorm solver_;
};

bool same(const Board& a, const Board& b) {
  return a.square_mm == b.square_mm && a.about_square == b.about_square && a.period == b.period &&
         a.ink == b.ink;
}

bool same(const FilmOptions& a, const FilmOptions& b) {
  return a.width_mm == b.width_mm && a.height_mm == b.height_mm && a.margin_mm == b.margin_mm &&
         a.shape == b.shape && a.swelling_x == b.swelling_x && a.swelling_y == b.swelling_y;
}

// Lays the scan on a dip's corners: as a whole, then so that what the film's place explains is left
// to the film.
Eigen::Isometry3d laid_on(const Subject& subject, const Board& board, const Landings& landings,
                          Vec2& film_off_mm) {
  constexpr int kRounds = 5;
  constexpr std::size_t kFewest = 6;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const Pairs pairs = pairs_of(subject, landings);
  if (pairs.corner.size() < kFewest) return pose;
  if (subject.match) pose = rigid_motion(pairs.scanned, pairs.landed);
  std::vector<GridPlace> places;
  for (const std::size_t c : pairs.corner) places.push_back(*subject.place[c]);
  const bool pose_known = !subject.match;
  const OpenAmounts amounts(open_motions(board, landings, places, pose_known));
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::Matrix3Xd left =
        ((pose.linear() * pairs.scanned).colwise() + pose.translation()) - pairs.landed;
    const Eigen::VectorXd amount = amounts.of(left.reshaped());
    film_off_mm = amount.segment<2>(pose_known ? 0 : 6);
    if (pose_known) break;
    pose = moved_a_little(pose, -amount.head<3>(), -amount.segment<3>(3));
  }
  return pose;
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

WarpedGrid warped_near(const Subject& subject, const Board& board, const Landings& landings) {
  CornerGrid grid = subject.scan.grid;
  if (subject.match) {
    const GridLanding landing = [&](const GridPlace& place) -> std::optional<Vec3> {
      const Landing* found = landings.find(place);
      return found != nullptr ? std::optional<Vec3>(found->position) : std::nullopt;
    };
    grid = moved(grid, align(grid, *subject.match, *subject.surface, landing).pose);
  }
  WarpedGrid warped(grid.position.size());
  for (std::size_t c = 0; c < warped.size(); ++c) {
    const Landing* landing = subject.place[c] ? landings.find(*subject.place[c]) : nullptr;
    if (landing != nullptr)
      warped[c] = board.on_film(*subject.place[c]) +
                  by_object(*landing) * (grid.position[c] - landing->position);
  }
  return warped;
}

ScanMisfits misfits_of(const Subject& subject, const Board& board,
                       const std::vector<const Landings*>& dips) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::size_t corners = subject.place.size();
  std::vector<GridPlace> places;
  for (const auto& place : subject.place) places.push_back(place.value_or(GridPlace{1 << 20, 0}));
  ScanMisfits result;
  result.misfits.value =
      Eigen::MatrixXd::Constant(3 * Eigen::Index(corners), Eigen::Index(dips.size()), nan);
  result.misfits.open = open_motions(board, dips.front() != nullptr ? *dips.front() : Landings(),
                                     places, !subject.match);
  if (dips.front() == nullptr) return result;
  const Eigen::Isometry3d pose = laid_on(subject, board, *dips.front(), result.film_off_mm);
  for (std::size_t d = 0; d < dips.size(); ++d)
    for (std::size_t c = 0; c < corners && dips[d] != nullptr; ++c)
      if (const Landing* landing = dips[d]->find(places[c]))
        result.misfits.value.block<3, 1>(3 * Eigen::Index(c), Eigen::Index(d)) =
            pose * subject.scan.grid.position[c] - landing->position;
  return result;
}

namespace {

// A measured dip says itself how its scan is to be read.
void require_scans_to_read(const CalibrationRequest& request) {
  const bool told = request.square_mm != 0 || !request.board.empty() ||
                    !request.scan_units.empty() || request.mirrored;
  if (told && !request.scans.empty() && std::ranges::all_of(request.scans, is_measured_dip))
    throw InputError(fmt::format(
        "{}: holds its board, its units and its side; --square, --board, --scan-units and "
        "--mirrored are for scans given as OBJECT=SCAN",
        request.scans.front()));
}

}  // namespace

ScanSetup scan_setup(const JobConfig& config, const CalibrationRequest& request) {
  require_no_correction_of_board(config);
  require_scans_to_read(request);
  ScanSetup setup = {config,
                     {{request.scan_units, request.square_mm, request.mirrored},
                      board_named(request.board, request.square_mm),
                      request.aligned}};
  setup.settings.file.square_mm = setup.settings.board.square_mm;
  std::string first;
  for (const std::string& text : request.scans) {
    if (!is_measured_dip(text)) continue;
    MeasuredDip dip = read_measured_dip(text);
    FilmOptions& film = setup.config.design.film;
    if (!dip.says_swelling) {
      dip.film.swelling_x = film.swelling_x;
      dip.film.swelling_y = film.swelling_y;
    }
    if (!first.empty() && (!same(dip.board, setup.settings.board) || !same(dip.film, film)))
      throw InputError(
          fmt::format("{}: another board, or a sheet of another size or swelling, was dipped than "
                      "in {}; calibrate them one by one",
                      text, first));
    first = text;
    setup.settings.board = dip.board;
    setup.settings.file.square_mm = dip.board.square_mm;
    film.width_mm = dip.film.width_mm;
    film.height_mm = dip.film.height_mm;
    film.margin_mm = dip.film.margin_mm;
    film.shape = dip.film.shape;
    film.swelling_x = dip.film.swelling_x;
    film.swelling_y = dip.film.swelling_y;
  }
  return setup;
}

std::vector<Subject> load_subjects(const std::vector<std::string>& texts,
                                   const ScanSettings& settings, const JobConfig& config,
                                   const RunContext& context) {
  if (texts.empty())
    throw InputError("no scan is given: name object and scan, as sphere-90=scan.obj");
  RunContext quiet = context.quiet();
  const double program = program_mark(quiet);
  std::vector<Subject> subjects;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    context.progress("reading scans", double(i) / double(texts.size()));
    Subject subject;
    std::string object;
    if (is_measured_dip(texts[i])) {
      MeasuredDip dip = read_measured_dip(texts[i]);
      object = fmt::format("{}@{}", dip.object, dip.depth_mm);
      subject.file = texts[i];
      subject.scan = std::move(dip.scan);
    } else {
      const SubjectText text = split(texts[i]);
      object = text.object;
      subject.file = text.file;
      subject.scan = read_scan(text.file, settings.file, context);
    }
    subject.object = calibration_object(object, config, context);
    subject.lengths = grid_lengths(subject.scan.grid);
    find_how_it_lies(subject, settings, config, context);
    subject.fingerprint = fingerprint_of(subject.object, settings.board, config.design, program);
    subjects.push_back(std::move(subject));
  }
  number_namesakes(subjects);
  context.progress("reading scans", 1);
  return subjects;
}

void require_film_on_most(const Subject& subject, const CornersWithoutFilm& corners,
                          const RunContext& context) {
  const std::string bare =
      fmt::format("{}: {} of {} corners lie where the simulated dip lays no film",
                  subject.file.string(), corners.bare, corners.of);
  const std::string check = fmt::format("check the depth ('{}@DEPTH=...')", subject.object.name);
  if (2 * corners.bare > corners.of)
    throw InputError(fmt::format("{}, too many for the others to say anything; {}", bare, check));
  if (5 * corners.bare > corners.of) context.warn(fmt::format("{}; {}.", bare, check));
}

bool any_synthetic(const std::vector<Subject>& subjects) {
  return std::any_of(subjects.begin(), subjects.end(),
                     [](const Subject& subject) { return subject.scan.synthetic; });
}

std::vector<std::filesystem::path> files_of(const std::vector<Subject>& subjects,
                                            const JobConfig& config) {
  std::vector<std::filesystem::path> files = config.settings_files;
  files.reserve(files.size() + subjects.size());
  for (const Subject& subject : subjects) files.push_back(subject.file);
  return files;
}

}  // namespace hydrodip
