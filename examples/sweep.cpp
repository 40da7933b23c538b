// One parameter, several values, all at once: how much film the object takes along, depending on
// how the film follows slopes.
#include <hydrodip/hydrodip.h>

#include <cstdio>
#include <future>
#include <vector>

int main() {
  // Shared by all dips: values never change, so that threads need no locks.
  const hydrodip::PosedObject posed =
      hydrodip::pose(hydrodip::sample("ellipsoid"), {.size_mm = 60});

  const auto dip = [&posed](double z_stretch) {
    hydrodip::SimulationOptions options;
    options.film = {.width_mm = 110, .height_mm = 110, .elements = 6000};
    options.trajectory.depth_mm = 12;
    options.dip.step_mm = 0.25;
    options.dip.material = {.z_stretch = z_stretch, .tear_stretch = 0};
    // One thread each: the dips share the processor, not the loops of one dip.
    return hydrodip::simulate(posed, options, hydrodip::RunContext().with_threads(1));
  };

  const std::vector<double> values = {0.4, 0.5, 0.6, 0.7, 0.8, 0.9};
  std::vector<std::future<hydrodip::DippedObject>> dips;
  for (const double value : values) dips.push_back(std::async(std::launch::async, dip, value));

  std::printf("z_stretch  film on object, mm2  mean area ratio\n");
  std::vector<hydrodip::DippedObject> results;
  for (std::size_t n = 0; n < values.size(); ++n) {
    results.push_back(dips[n].get());
    const hydrodip::Coverage& coverage = results.back().coverage;
    std::printf("%9.2f  %19.2f  %15.4f\n", values[n], coverage.film_on_object_mm2,
                coverage.area_ratio_mean);
  }

  // What a dip gives depends neither on its neighbours nor on the number of threads.
  const hydrodip::DippedObject alone = dip(values[2]);
  std::printf("the same as alone: %s\n",
              alone.film->position == results[2].film->position ? "yes" : "no");
}
