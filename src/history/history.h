// What was done with one job: every dip with its readings, kept in JOB/history.sqlite.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace hydrodip {

// One dip. What was not measured or said is empty.
struct DipRun {
  std::string id;             // "rig-3": guided, in the folder of that name; "hand-1": told later
  std::string started_utc;    // ISO 8601
  std::string report_sha256;  // of the report.json that it was dipped by
  std::string batch, label;   // of the piece
  // "done" (to its end, not judged yet), "good", "failed", "cancelled", "unfinished" (it has no end
  // yet: under way, or its computer went off)
  std::string outcome;
  std::optional<double> water_before_c, water_after_c;
  std::optional<double> soak_s;
  std::optional<double> activator_g;
  std::optional<double> registration_x_mm, registration_y_mm, registration_deg;
  std::string notes;
};

// Fields of a run that people give or correct, by name: batch, label, outcome, notes,
// water_before_c,
// ... as in DipRun.
using RunFields = std::map<std::string, std::string>;

class History {
 public:
  // Opens or makes JOB/history.sqlite and takes in what the logs of JOB/rig-N say. Throws
  // InputError if the file is none of ours, of a newer version, or cannot be written; one that was
  // made for nothing is gone again. `only_look`: nothing will be added or amended; a folder in
  // which nothing was dipped stays as it is, and so does one that cannot be written to.
  explicit History(const std::filesystem::path& job_folder, bool only_look = false);
  ~History();
  History(const History&) = delete;
  History& operator=(const History&) = delete;

  // Folders of runs that are not among these, as their logs are empty or damaged: "rig-3".
  const std::vector<std::string>& unread() const { return unread_; }
  // In order of time.
  std::vector<DipRun> runs() const;
  // A dip that was made without `rig guide`. Returns its id. Throws InputError for unknown fields,
  // or values that are none.
  std::string add(const std::string& started_utc, const std::string& report_sha256,
                  const RunFields& fields);
  // Throws InputError as add and amend do.
  static void require_fields(const RunFields& fields);
  void require_run(const std::string& id) const;
  // Corrects what a run's log says, or judges the piece. Throws InputError as add, or if there is
  // no such run.
  void amend(const std::string& id, const RunFields& fields);
  // Takes a dip away that was added. Throws InputError if there is none of that id, or a log tells
  // of it, which would bring it back.
  void remove(const std::string& id);
  // The report.json of that hash, if it was there when the run was taken in. Empty: it was not.
  std::string report(const std::string& sha256) const;

 private:
  struct Database;
  std::filesystem::path folder_;
  std::vector<std::string> unread_;
  std::unique_ptr<Database> database_;
};

}  // namespace hydrodip
