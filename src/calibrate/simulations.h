// Many simulated dips at once: one thread each, results kept in a store.
#pragma once

#include <string>
#include <vector>

#include "calibrate/store.h"
#include "calibrate/subject.h"
#include "scan/board.h"

namespace hydrodip {

// One dip of one subject.
struct SimulationRequest {
  std::size_t subject = 0;
  FilmParameters parameters;
};

// Dips subjects on one film, or looks up what is known already.
class Simulations {
 public:
  // Refers to all but the board. `level` tells films apart in the store ("search", "fine").
  Simulations(const std::vector<Subject>& subjects, const DesignOptions& design, const Board& board,
              const std::string& level, SimulationStore& store);
  // The same on a film that is at hand.
  Simulations(const std::vector<Subject>& subjects, const DesignOptions& design, CheckeredFilm film,
              const std::string& level, SimulationStore& store);
  const CheckeredFilm& film() const { return film_; }

  // In the order of the requests. Computes what the store does not have, as many at once as there
  // are threads, and keeps each as it is done. Progress under the name `activity`. Throws
  // Cancelled: what was finished by then is kept.
  std::vector<SimulationResult> get(const std::vector<SimulationRequest>& requests,
                                    const std::string& activity, const RunContext& context);

  // How many of the requests the store lacks.
  std::size_t missing(const std::vector<SimulationRequest>& requests) const;

 private:
  SimulationKey key_of(const SimulationRequest& request) const;
  SimulationResult compute(const SimulationRequest& request, const RunContext& context) const;

  const std::vector<Subject>& subjects_;
  DesignOptions design_;
  CheckeredFilm film_;
  std::string level_;
  SimulationStore& store_;
};

}  // namespace hydrodip
