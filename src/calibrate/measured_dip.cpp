#include "calibrate/measured_dip.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "base/error.h"
#include "base/file.h"
#include "base/json_nesting.h"
#include "base/json_text.h"
#include "base/schema_version.h"
#include "calibrate/checkerboard_dip.h"
#include "model_io/archive_writer.h"
#include "model_io/package.h"
#include "model_io/text.h"

namespace hydrodip {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kSchemaVersion = 2;  // 2: sheet.swelling_x, swelling_y
constexpr const char* kKind = "hydrodip measured dip";
constexpr const char *kFactsName = "dip.json", *kCornersName = "corners.csv";
constexpr const char* kCornersHeading = "patch,column,row,x,y,z";
constexpr std::size_t kMostCorners = 1000000;

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why) {
  throw InputError(fmt::format("{}: {}", file.string(), why));
}

// ---- what has to be told, and in which bounds ----

struct TextFact {
  const char* key;
  const char* option;  // nullptr: not asked for
  std::string DipFacts::*member;
};
constexpr TextFact kTexts[] = {{"film", "--film-product", &DipFacts::film},
                               {"printer", "--printer", &DipFacts::printer},
                               {"ink", "--ink", &DipFacts::ink},
                               {"activator", "--activator", &DipFacts::activator},
                               {"owner", "--owner", &DipFacts::owner},
                               {"licence", "--licence", &DipFacts::licence},
                               {"dipped_on", nullptr, &DipFacts::dipped_on},
                               {"notes", nullptr, &DipFacts::notes}};
struct NumberFact {
  const char* key;
  const char* option;
  bool needed;
  double least, most;
  std::optional<double> DipFacts::*member;
};
constexpr NumberFact kNumbers[] = {
    {"water_c", "--water-c", true, 0, 100, &DipFacts::water_c},
    {"soak_s", "--soak-s", true, 0, 3600, &DipFacts::soak_s},
    {"activator_g", "--activator-g", true, 0, 1000, &DipFacts::activator_g},
    {"wait_s", "--wait-s", true, 0, 3600, &DipFacts::wait_s},
    {"speed_mm_per_min", "--speed", false, 0.1, 100000, &DipFacts::speed_mm_per_min}};

// ---- numbers and texts of a file that may say anything ----

class Reader {
 public:
  Reader(const std::filesystem::path& file, const Json& json) : file_(file), json_(json) {}

  Reader at(const char* key) const {
    if (!json_.contains(key) || !json_[key].is_object()) damaged(key);
    return {file_, json_[key]};
  }
  double number(const char* key, double least, double most) const {
    if (!json_.contains(key) || !json_[key].is_number()) damaged(key);
    const double value = json_[key];
    if (!(value >= least && value <= most)) damaged(key);
    return value;
  }
  std::string text(const char* key) const {
    if (!json_.contains(key) || !json_[key].is_string()) damaged(key);
    return json_[key];
  }
  bool flag(const char* key) const {
    if (!json_.contains(key) || !json_[key].is_boolean()) damaged(key);
    return json_[key];
  }
  bool has(const char* key) const { return json_.contains(key) && !json_[key].is_null(); }
  const Json& list(const char* key) const {
    if (!json_.contains(key) || !json_[key].is_array()) damaged(key);
    return json_[key];
  }
  [[noreturn]] void damaged(const char* key) const {
    refuse(file_,
           fmt::format("{}: '{}' is missing or says something that cannot be", kFactsName, key));
  }

 private:
  const std::filesystem::path& file_;
  const Json& json_;
};

// "2026-11-27", a day that there is.
bool is_date(const std::string& text) {
  const bool shaped =
      text.size() == 10 && text[4] == '-' && text[7] == '-' &&
      std::ranges::count_if(text, [](unsigned char c) { return std::isdigit(c) != 0; }) == 8;
  if (!shaped) return false;
  const auto part = [&](std::size_t from, std::size_t count) {
    return unsigned(std::stoul(text.substr(from, count)));
  };
  return (std::chrono::year(int(part(0, 4))) / std::chrono::month(part(5, 2)) /
          std::chrono::day(part(8, 2)))
      .ok();
}

Json json_of(const DipFacts& facts) {
  Json json;
  for (const TextFact& fact : kTexts) json[fact.key] = facts.*fact.member;
  for (const NumberFact& fact : kNumbers)
    json[fact.key] = facts.*fact.member ? Json(*(facts.*fact.member)) : Json(nullptr);
  return json;
}

DipFacts facts_of(const Reader& json) {
  DipFacts facts;
  for (const TextFact& fact : kTexts) facts.*fact.member = json.text(fact.key);
  for (const NumberFact& fact : kNumbers)
    if (json.has(fact.key)) facts.*fact.member = json.number(fact.key, fact.least, fact.most);
  return facts;
}

Board board_of(const Reader& json) {
  constexpr int kMostPeriod = 64;
  Board board;
  board.name = json.text("name");
  board.square_mm = json.number("square_mm", 0.5, 100);
  board.about_square = json.flag("about_square");
  board.period = int(json.number("period", 1, kMostPeriod));
  const Json& inks = json.list("ink");
  if (inks.size() != std::size_t(board.period * board.period)) json.damaged("ink");
  for (const Json& ink : inks) {
    if (!ink.is_number_integer() || ink.get<std::int64_t>() < 0 || ink.get<std::int64_t>() > 255)
      json.damaged("ink");
    board.ink.push_back(ink.get<std::uint8_t>());
  }
  return board;
}

FilmOptions film_of(const Reader& json, bool says_swelling) {
  FilmOptions film;
  film.width_mm = json.number("width_mm", 10, 5000);
  film.height_mm = json.number("height_mm", 10, 5000);
  film.margin_mm = json.number("margin_mm", 0, 1000);
  const std::string shape = json.text("shape");
  if (shape != "rectangle" && shape != "disc") json.damaged("shape");
  film.shape = shape == "disc" ? FilmShape::kDisc : FilmShape::kRectangle;
  if (says_swelling) {
    film.swelling_x = json.number("swelling_x", 0.8, 1.5);
    film.swelling_y = json.number("swelling_y", 0.8, 1.5);
  }
  return film;
}

// ---- corners ----

std::string corners_csv(const CornerGrid& grid) {
  std::string text = fmt::format("{}\n", kCornersHeading);
  for (std::size_t c = 0; c < grid.position.size(); ++c) {
    const Vec3& p = grid.position[c];
    text += fmt::format("{},{},{},{},{},{}\n", grid.patch[c], grid.place[c][0], grid.place[c][1],
                        p.x(), p.y(), p.z());
  }
  return text;
}

CornerGrid corners_of(const std::filesystem::path& file, std::string_view rest) {
  CornerGrid grid;
  std::set<std::array<int, 3>> seen;
  const std::string_view heading = take_line(rest);
  for (std::size_t number = 2; !rest.empty(); ++number) {
    std::string line(take_line(rest));
    std::replace(line.begin(), line.end(), ',', ' ');
    std::string_view words = line;
    std::array<std::int64_t, 3> place{};
    Vec3 p;
    bool good = heading == kCornersHeading && grid.position.size() < kMostCorners;
    for (auto& value : place)
      good = good && parse_integer(take_word(words), value) && std::abs(value) < 100000;
    for (int k = 0; k < 3; ++k) good = good && parse_number(take_word(words), p[k]);
    const std::array<int, 3> key = {int(place[0]), int(place[1]), int(place[2])};
    if (!good || !take_word(words).empty() || !seen.insert(key).second)
      refuse(file, fmt::format("{}, line {}: not a corner '{}' of its own", kCornersName, number,
                               kCornersHeading));
    grid.position.push_back(p);
    grid.patch.push_back(key[0]);
    grid.place.push_back({key[1], key[2]});
  }
  if (grid.position.empty()) refuse(file, fmt::format("{} holds no corners", kCornersName));
  return grid;
}

std::vector<std::uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

}  // namespace

void require_facts(const DipFacts& facts) {
  std::string missing;
  const auto ask = [&](const char* option) {
    missing += (missing.empty() ? "" : ", ") + std::string(option);
  };
  for (const TextFact& fact : kTexts)
    if (fact.option != nullptr && (facts.*fact.member).empty()) ask(fact.option);
  for (const NumberFact& fact : kNumbers)
    if (fact.needed && !(facts.*fact.member)) ask(fact.option);
  if (!missing.empty())
    throw InputError(fmt::format(
        "calibrate pack: a dip can be computed against only if it is known how it was made; say {}",
        missing));
  for (const NumberFact& fact : kNumbers)
    if (const auto& value = facts.*fact.member;
        value && !(*value >= fact.least && *value <= fact.most))
      throw InputError(fmt::format("{} {:g}: give a value from {:g} to {:g}", fact.option, *value,
                                   fact.least, fact.most));
  if (!facts.dipped_on.empty() && !is_date(facts.dipped_on))
    throw InputError(fmt::format("--dipped-on '{}': give the day as year-month-day, 2026-11-27",
                                 facts.dipped_on));
  const bool is_identifier = std::all_of(
      facts.licence.begin(), facts.licence.end(),
      [](unsigned char c) { return std::isalnum(c) != 0 || c == '-' || c == '.' || c == '+'; });
  if (!is_identifier)
    throw InputError(fmt::format(
        "--licence '{}': give its SPDX identifier, as CC-BY-4.0 or CC0-1.0 (spdx.org/licenses)",
        facts.licence));
}

bool is_measured_dip(const std::string& text) {
  return text.ends_with(".zip") && text.find('=') == std::string::npos;
}

void write_measured_dip(const std::filesystem::path& file, const MeasuredDip& dip) {
  const std::vector<std::uint8_t> corners = bytes_of(corners_csv(dip.scan.grid));
  const Board& board = dip.board;
  const Json json = {
      {"kind", kKind},
      {"schema_version", kSchemaVersion},
      {"object", {{"shape", dip.object}, {"depth_mm", dip.depth_mm}}},
      {"board",
       {{"name", board.name},
        {"square_mm", board.square_mm},
        {"about_square", board.about_square},
        {"period", board.period},
        {"ink", board.ink}}},
      {"sheet",
       {{"width_mm", dip.film.width_mm},
        {"height_mm", dip.film.height_mm},
        {"margin_mm", dip.film.margin_mm},
        {"shape", dip.film.shape == FilmShape::kDisc ? "disc" : "rectangle"},
        {"swelling_x", dip.film.swelling_x},
        {"swelling_y", dip.film.swelling_y}}},
      {"facts", json_of(dip.facts)},
      {"scan", {{"synthetic", dip.scan.synthetic}, {"corners", dip.scan.grid.position.size()}}},
      {"files",
       {{{"name", kCornersName}, {"sha256", sha256_hex(corners)}},
        {{"name", dip.scan_file}, {"sha256", sha256_hex(dip.source)}}}}};
  const std::vector<std::uint8_t> facts = bytes_of(json_text(json));
  ArchiveWriter archive(file, file.string(), kKind);
  archive.add(kFactsName, facts);
  archive.add(kCornersName, corners);
  archive.add(dip.scan_file, dip.source);
  archive.close();
}

MeasuredDip read_measured_dip(const std::filesystem::path& file) {
  const std::string name = file.string();
  const std::vector<std::uint8_t> bytes = read_file(file);
  const auto or_damaged = [&](const auto& act) {
    try {
      return act();
    } catch (const InputError&) {  // speaks of models
      refuse(file, "this is no measured dip, or a damaged one; fetch it again");
    }
  };
  const auto opened = or_damaged([&] { return std::make_unique<Package>(name, bytes); });
  Package& package = *opened;
  const auto read = [&](const std::string& part) {
    return or_damaged([&] { return package.read(part); });
  };
  const auto has = [&](const std::string& part) {
    return std::find(package.names().begin(), package.names().end(), part) != package.names().end();
  };
  if (!has(kFactsName) || !has(kCornersName))
    refuse(file, "this is no measured dip: 'hydrodip calibrate pack' makes them");
  const std::vector<std::uint8_t> facts = read(kFactsName);
  const Json json = parsed_json<Json>(facts);
  if (!json.is_object() || !json.contains("kind") || json["kind"] != kKind)
    refuse(file, "this is no measured dip: 'hydrodip calibrate pack' makes them");
  const Reader reader(file, json);
  require_known_schema(json, kSchemaVersion, file, "this measured dip");
  const double version = reader.number("schema_version", 1, kSchemaVersion);

  MeasuredDip dip;
  dip.object = reader.at("object").text("shape");
  if (find_shape(dip.object) == nullptr) reader.at("object").damaged("shape");
  dip.depth_mm = reader.at("object").number("depth_mm", 0.1, 5000);
  dip.board = board_of(reader.at("board"));
  dip.says_swelling = version >= 2;
  dip.film = film_of(reader.at("sheet"), dip.says_swelling);
  dip.facts = facts_of(reader.at("facts"));
  dip.scan.synthetic = reader.at("scan").flag("synthetic");
  for (const Json& entry : reader.list("files")) {
    if (!entry.is_object()) reader.damaged("files");
    const Reader part(file, entry);
    const std::string part_name = part.text("name");
    if (!has(part_name)) refuse(file, fmt::format("{} is missing from it", part_name));
    std::vector<std::uint8_t> content = read(part_name);
    if (sha256_hex(content) != part.text("sha256"))
      refuse(file, fmt::format("{} was changed since it was packed, or is damaged", part_name));
    if (part_name == kCornersName) {
      dip.scan.grid = corners_of(file, text_of(content));
    } else {
      dip.scan_file = part_name;
      dip.source = std::move(content);
    }
  }
  if (dip.scan.grid.position.empty()) reader.damaged("files");
  return dip;
}

}  // namespace hydrodip
