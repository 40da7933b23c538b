// The only place that knows SQLite.
#include "history/history.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "base/file.h"
#include "base/nearest_name.h"
#include "base/parse_double.h"
#include "history/run_log.h"

namespace hydrodip {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFile = "history.sqlite";
constexpr const char* kByHand = "hand-";  // and a number
constexpr int kPatience_ms = 5000;        // while another process writes

// A table has what the logs say, another what people say about it, so that neither loses the other.
constexpr const char* kSchema = R"(
  CREATE TABLE IF NOT EXISTS hydrodip (schema_version INTEGER NOT NULL);
  INSERT INTO hydrodip SELECT 1 WHERE NOT EXISTS (SELECT 1 FROM hydrodip);
  CREATE TABLE IF NOT EXISTS reports (sha256 TEXT PRIMARY KEY, report TEXT NOT NULL);
  CREATE TABLE IF NOT EXISTS runs (id TEXT PRIMARY KEY, started_utc TEXT NOT NULL,
    report_sha256 TEXT NOT NULL);
  CREATE TABLE IF NOT EXISTS readings (run TEXT NOT NULL, field TEXT NOT NULL, value TEXT NOT NULL,
    PRIMARY KEY (run, field));
  CREATE TABLE IF NOT EXISTS amendments (run TEXT NOT NULL, field TEXT NOT NULL,
    value TEXT NOT NULL, PRIMARY KEY (run, field));
)";

struct NumberField {
  const char* name;
  std::optional<double> DipRun::*member;
  double least, most;
};
constexpr std::array<NumberField, 7> kNumbers = {
    {{"water_before_c", &DipRun::water_before_c, 0, 100},
     {"water_after_c", &DipRun::water_after_c, 0, 100},
     {"soak_s", &DipRun::soak_s, 0, 86400},
     {"activator_g", &DipRun::activator_g, 0, 100000},
     {"registration_x_mm", &DipRun::registration_x_mm, -1000, 1000},
     {"registration_y_mm", &DipRun::registration_y_mm, -1000, 1000},
     {"registration_deg", &DipRun::registration_deg, -360, 360}}};

struct TextField {
  const char* name;
  std::string DipRun::*member;
};
constexpr std::array<TextField, 4> kTexts = {{{"batch", &DipRun::batch},
                                              {"label", &DipRun::label},
                                              {"outcome", &DipRun::outcome},
                                              {"notes", &DipRun::notes}}};

std::optional<double> number_of(const std::string& text) {
  std::string with_point = text;
  std::ranges::replace(with_point, ',', '.');
  double value = 0;
  const char* end = with_point.data() + with_point.size();
  const auto [rest, error] = parse_double(with_point.data(), end, value);
  if (error != std::errc() || rest != end || !std::isfinite(value)) return {};
  return value;
}

void check_field(const std::string& name, const std::string& value) {
  if (name == "outcome" && value != "good" && value != "failed")
    throw InputError(fmt::format("outcome: a piece is good or failed, not '{}'", value));
  for (const NumberField& field : kNumbers) {
    if (name != field.name) continue;
    const auto number = number_of(value);
    if (!number || *number < field.least || *number > field.most)
      throw InputError(fmt::format("{}: must be a number from {:g} to {:g}, not '{}'", name,
                                   field.least, field.most, value));
    return;
  }
  std::vector<std::string> names;
  names.reserve(std::size(kTexts) + std::size(kNumbers));
  for (const TextField& field : kTexts) names.emplace_back(field.name);
  if (std::ranges::find(names, name) != names.end()) return;
  for (const NumberField& field : kNumbers) names.emplace_back(field.name);
  throw InputError(fmt::format("a run has no field '{}'{}", name, did_you_mean(name, names)));
}

void set_field(DipRun& run, const std::string& name, const std::string& value) {
  for (const NumberField& field : kNumbers)
    if (name == field.name) run.*field.member = number_of(value);
  for (const TextField& field : kTexts)
    if (name == field.name) run.*field.member = value;
}

RunFields fields_of(const DipRun& run) {
  RunFields fields;
  for (const NumberField& field : kNumbers)
    if (run.*field.member) fields[field.name] = fmt::format("{}", *(run.*field.member));
  for (const TextField& field : kTexts)
    if (!(run.*field.member).empty()) fields[field.name] = run.*field.member;
  return fields;
}

// The file cannot be written, or be read.
struct CannotWrite : InputError {
  using InputError::InputError;
};

}  // namespace

struct History::Database {
  explicit Database(const fs::path& path) : file(path) {
    std::error_code ignored;
    const bool is_new = !fs::exists(file, ignored);
    open(SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, file);
    made = is_new;
  }
  // What the file holds, and what is written goes nowhere; no file: nothing.
  struct Copy {};
  Database(const fs::path& path, Copy) : file(path) {
    std::error_code ignored;
    const bool is_there = fs::exists(file, ignored);
    if (is_there) open(SQLITE_OPEN_READONLY, file);
    const Handle from = std::move(handle);
    open(SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, ":memory:");
    if (!is_there) return;
    sqlite3_backup* const copying = sqlite3_backup_init(handle.get(), "main", from.get(), "main");
    if (copying) sqlite3_backup_step(copying, -1);
    if (sqlite3_backup_finish(copying) != SQLITE_OK) fail();
  }
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;
  ~Database() {
    if (!made || !out_of_room || !is_empty()) return;
    handle.reset();
    std::error_code ignored;
    fs::remove(file, ignored);
  }

  void open(int how, const fs::path& from) {
    sqlite3* opened = nullptr;
    const int result = sqlite3_open_v2(from.string().c_str(), &opened, how, nullptr);
    handle.reset(opened);
    if (result != SQLITE_OK) fail();
    sqlite3_busy_timeout(handle.get(), kPatience_ms);
  }

  bool is_empty() const noexcept {
    try {
      if (query("SELECT name FROM sqlite_master").empty()) return true;
      return query("SELECT id FROM runs UNION ALL SELECT sha256 FROM reports LIMIT 1").empty();
    } catch (...) {
      return false;
    }
  }

  // Throws InputError before anything is written into a file of another version.
  void prepare() const {
    require_known_version();
    execute(kSchema);
  }

  void require_known_version() const {
    if (query("SELECT name FROM sqlite_master WHERE name = 'hydrodip'").empty()) return;
    const auto version = query("SELECT schema_version FROM hydrodip");
    if (!version.empty() && version.front().front() != "1")
      throw InputError(fmt::format("{}: made by a newer hydrodip; use that one", file.string()));
  }

  [[noreturn]] void fail() const {
    const int code = sqlite3_errcode(handle.get());
    out_of_room = out_of_room || is_about_room(code);
    const std::string why = fmt::format("{}: the history cannot be read or written ({}); {}",
                                        file.string(), sqlite3_errmsg(handle.get()), way_out(code));
    if (is_about_room(code) || is_about_permission(code)) throw CannotWrite(why);
    throw InputError(why);
  }

  static bool is_about_room(int code) {
    return (code & 0xff) == SQLITE_FULL || (code & 0xff) == SQLITE_IOERR;
  }

  static bool is_about_permission(int code) {
    switch (code & 0xff) {
      case SQLITE_READONLY:
      case SQLITE_CANTOPEN:
      case SQLITE_PERM:
      case SQLITE_AUTH:
        return true;
      default:
        return false;
    }
  }

  static const char* way_out(int code) {
    if (is_about_permission(code))
      return "it is kept in the job's folder, which has to be writable, and so has the file";
    if (is_about_room(code)) return "free space on its disk";
    switch (code & 0xff) {
      case SQLITE_BUSY:
      case SQLITE_LOCKED:
        return "another program is at it: try again when it has ended";
      default:
        return "move the file away, and the dips are read from the runs' logs again; what people "
               "told later (outcomes, notes, corrections, dips without the guide) and the reports "
               "of earlier prints are in that file alone";
    }
  }

  void execute(const char* sql) const {
    if (sqlite3_exec(handle.get(), sql, nullptr, nullptr, nullptr) != SQLITE_OK) fail();
  }

  using Row = std::vector<std::string>;
  std::vector<Row> query(const char* sql, const std::vector<std::string>& values = {}) const {
    sqlite3_stmt* statement = nullptr;
    if (sqlite3_prepare_v2(handle.get(), sql, -1, &statement, nullptr) != SQLITE_OK) fail();
    const std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)> owner(statement, sqlite3_finalize);
    for (std::size_t i = 0; i < values.size(); ++i)
      sqlite3_bind_text(statement, int(i) + 1, values[i].data(), int(values[i].size()),
                        SQLITE_TRANSIENT);
    std::vector<Row> rows;
    int result = 0;
    while ((result = sqlite3_step(statement)) == SQLITE_ROW) {
      Row row;
      for (int i = 0; i < sqlite3_column_count(statement); ++i) {
        const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement, i));
        row.emplace_back(text != nullptr ? text : "");
      }
      rows.push_back(std::move(row));
    }
    if (result != SQLITE_DONE) fail();
    return rows;
  }

  // All of it, or nothing.
  template <class Work>
  void transact(const Work& work) const {
    execute("BEGIN IMMEDIATE");
    try {
      work();
    } catch (...) {
      sqlite3_exec(handle.get(), "ROLLBACK", nullptr, nullptr, nullptr);
      throw;
    }
    execute("COMMIT");
  }

  void put(const DipRun& run) const {
    query("INSERT OR REPLACE INTO runs VALUES (?, ?, ?)",
          {run.id, run.started_utc, run.report_sha256});
    query("DELETE FROM readings WHERE run = ?", {run.id});
    for (const auto& [field, value] : fields_of(run))
      query("INSERT INTO readings VALUES (?, ?, ?)", {run.id, field, value});
  }

  using Handle = std::unique_ptr<sqlite3, int (*)(sqlite3*)>;
  fs::path file;
  Handle handle{nullptr, sqlite3_close};
  bool made = false;                 // the file was not there
  mutable bool out_of_room = false;  // something could not be written for want of room
};

History::History(const fs::path& job_folder, bool only_look) : folder_(job_folder) {
  std::vector<DipRun> logged;
  std::error_code error;
  for (fs::directory_iterator entry(folder_, error), end; !error && entry != end;
       entry.increment(error))
    if (entry->path().filename().string().starts_with("rig-") && entry->is_directory()) {
      if (const auto run = read_run_log(entry->path()))
        logged.push_back(*run);
      else if (!is_begun_log(entry->path()))
        unread_.push_back(entry->path().filename().string());
    }
  std::vector<std::uint8_t> report;
  if (fs::exists(folder_ / "report.json", error)) report = read_file(folder_ / "report.json");
  const auto take_in = [&](std::unique_ptr<Database> database) {
    database_ = std::move(database);
    database_->transact([&] {
      database_->prepare();
      for (const DipRun& run : logged) database_->put(run);
      if (!report.empty())
        database_->query("INSERT OR IGNORE INTO reports VALUES (?, ?)",
                         {sha256_hex(report), std::string(report.begin(), report.end())});
    });
  };
  const auto look_at_copy = [&] {
    take_in(std::make_unique<Database>(folder_ / kFile, Database::Copy{}));
  };
  if (only_look && logged.empty() && !fs::exists(folder_ / kFile, error))
    look_at_copy();
  else
    try {
      take_in(std::make_unique<Database>(folder_ / kFile));
    } catch (const CannotWrite&) {
      if (!only_look) throw;
      look_at_copy();
    }
  // What an earlier look took in is there.
  std::erase_if(unread_, [&](const std::string& run) {
    return !database_->query("SELECT id FROM runs WHERE id = ?", {run}).empty();
  });
  std::ranges::sort(unread_);
}

History::~History() = default;

std::vector<DipRun> History::runs() const {
  std::vector<DipRun> runs;
  for (const auto& row : database_->query(
           "SELECT id, started_utc, report_sha256 FROM runs ORDER BY started_utc, id")) {
    DipRun run;
    run.id = row[0];
    run.started_utc = row[1];
    run.report_sha256 = row[2];
    for (const char* table : {"readings", "amendments"})
      for (const auto& reading : database_->query(
               fmt::format("SELECT field, value FROM {} WHERE run = ?", table).c_str(), {run.id}))
        set_field(run, reading[0], reading[1]);
    runs.push_back(std::move(run));
  }
  return runs;
}

std::string History::add(const std::string& started_utc, const std::string& report_sha256,
                         const RunFields& fields) {
  DipRun run;
  run.started_utc = started_utc;
  run.report_sha256 = report_sha256;
  run.outcome = "done";
  for (const auto& [name, value] : fields) {
    check_field(name, value);
    set_field(run, name, value);
  }
  database_->transact([&] {
    // Not their number: one of them may have been taken away.
    const auto last = database_->query(
        "SELECT COALESCE(MAX(CAST(SUBSTR(id, 6) AS INTEGER)), 0) FROM runs WHERE id LIKE 'hand-%'");
    run.id = fmt::format("{}{}", kByHand, std::stol(last.front().front()) + 1);
    database_->put(run);
  });
  return run.id;
}

void History::require_fields(const RunFields& fields) {
  for (const auto& [name, value] : fields) check_field(name, value);
}

void History::require_run(const std::string& id) const {
  std::vector<std::string> known;
  for (const auto& row : database_->query("SELECT id FROM runs")) known.push_back(row[0]);
  if (std::ranges::find(known, id) == known.end())
    throw InputError(
        fmt::format("there is no run '{}' in {}{}", id, folder_.string(),
                    known.empty() ? "; nothing was dipped yet" : did_you_mean(id, known)));
}

void History::remove(const std::string& id) {
  require_run(id);
  if (!id.starts_with(kByHand))
    throw InputError(fmt::format(
        "{}: 'hydrodip rig guide' kept this dip, and {} tells of it: only what --add told of can "
        "be removed; what became of a piece is corrected with --run {} --outcome",
        id, (folder_ / id / "log.jsonl").string(), id));
  database_->transact([&] {
    database_->query("DELETE FROM runs WHERE id = ?", {id});
    for (const char* table : {"readings", "amendments"})
      database_->query(fmt::format("DELETE FROM {} WHERE run = ?", table).c_str(), {id});
  });
}

void History::amend(const std::string& id, const RunFields& fields) {
  require_fields(fields);
  require_run(id);
  database_->transact([&] {
    for (const auto& [name, value] : fields)
      database_->query("INSERT OR REPLACE INTO amendments VALUES (?, ?, ?)", {id, name, value});
  });
}

std::string History::report(const std::string& sha256) const {
  const auto rows = database_->query("SELECT report FROM reports WHERE sha256 = ?", {sha256});
  return rows.empty() ? "" : rows.front().front();
}

}  // namespace hydrodip
