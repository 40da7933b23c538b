// What simulations of a calibration found, kept on disk as they come in: killed at any moment, a
// calibration goes on where it was.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/file_lock.h"
#include "calibrate/landings.h"

namespace hydrodip {

// Which simulation: a subject's fingerprint says object, film and board. Scans do not matter.
struct SimulationKey {
  std::string subject;
  FilmParameters parameters;
  bool operator<(const SimulationKey& other) const;
};

// Empty if that dip cannot be computed.
using SimulationResult = std::optional<Landings>;

// Text, a line of JSON per simulation, so that stores merge by putting one behind the other. A line
// cut short by a kill or a crash is dropped when the store is opened, other damaged lines are
// passed over. Only one process at a time may write; where the file system has no locks, oddities()
// says so.
class SimulationStore {
 public:
  // Opens or makes the file, and reads others beside it, which stay as they are. Throws InputError
  // if it cannot be read or written, has no line that a store has, or another process has it open.
  SimulationStore(const std::filesystem::path& file,
                  const std::vector<std::filesystem::path>& others);
  // A file that it made and into which nothing came goes again.
  ~SimulationStore();
  SimulationStore(const SimulationStore&) = delete;
  SimulationStore& operator=(const SimulationStore&) = delete;

  const SimulationResult* find(const SimulationKey& key) const;
  // On disk when it returns. Throws InputError when the disk is full.
  void add(const SimulationKey& key, const SimulationResult& result);
  std::size_t size() const { return results_.size(); }

  // What a user should know of the files: lines passed over, and results whose subject begins like
  // none of these. One sentence each.
  std::vector<std::string> oddities(const std::vector<std::string>& subjects) const;

 private:
  void read(const std::filesystem::path& file);
  void drop_torn_line();
  void remove_if_made_for_nothing() const;

  std::filesystem::path file_;
  bool made_ = false;
  FileLock lock_;
  struct FileRead {
    std::filesystem::path file;
    std::vector<std::size_t> damaged;               // lines
    std::map<std::string, std::size_t> of_subject;  // how many results
  };
  std::vector<FileRead> read_;
  std::map<SimulationKey, SimulationResult> results_;
};

}  // namespace hydrodip
