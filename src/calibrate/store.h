// What simulations of a calibration found, kept on disk as they come in: killed at any moment, a
// calibration goes on where it was.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "calibrate/checkerboard_dip.h"
#include "scan/grid_error.h"

namespace hydrodip {

// Which simulation: a subject's fingerprint says scan, object and film.
struct SimulationKey {
  std::string subject;
  FilmParameters parameters;
  bool operator<(const SimulationKey& other) const;
};

// The scan's corners on the film; empty if that dip cannot be computed.
using SimulationResult = std::optional<WarpedGrid>;

// Text, a line of JSON per simulation, so that stores merge by putting one behind the other. A line
// cut short by a kill or a crash is dropped when the store is opened. Only one process at a time
// may write.
class SimulationStore {
 public:
  // Opens or makes the file, and reads others beside it, which stay as they are. Throws InputError
  // if it cannot be read or written, is no store, or another process has it open.
  SimulationStore(const std::filesystem::path& file,
                  const std::vector<std::filesystem::path>& others);
  ~SimulationStore();
  SimulationStore(const SimulationStore&) = delete;
  SimulationStore& operator=(const SimulationStore&) = delete;

  const SimulationResult* find(const SimulationKey& key) const;
  // On disk when it returns. Throws InputError when the disk is full.
  void add(const SimulationKey& key, const SimulationResult& result);
  std::size_t size() const { return results_.size(); }

 private:
  void read(const std::filesystem::path& file);
  void drop_torn_line();

  std::filesystem::path file_;
  int descriptor_ = -1;
  std::map<SimulationKey, SimulationResult> results_;
};

}  // namespace hydrodip
