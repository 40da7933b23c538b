// From a model to a sheet that can be printed: print_job MODEL FOLDER
#include <hydrodip/hydrodip.h>

#include <cstdio>

int main(int argc, char** argv) try {
  if (argc != 3) {
    std::fprintf(stderr, "usage: print_job MODEL FOLDER\n");
    return 2;
  }
  const hydrodip::Model model = hydrodip::load(argv[1]);
  const hydrodip::PosedObject posed = hydrodip::pose(model, {.size_mm = 60});

  // Whatever is not said here is as `hydrodip params` lists it.
  hydrodip::DesignOptions options;
  options.film.width_mm = 100;
  options.film.height_mm = 120;
  options.film.elements = 4000;
  options.dip.step_mm = 0.5;
  options.dpi = 90;

  // Dips again and again until the film agrees with the ink that is to be printed on it.
  const auto paint = hydrodip::paint_of(model);
  const hydrodip::Printer printer = hydrodip::make_printer({});
  const hydrodip::Designed made = hydrodip::design(posed, *paint, options, printer);

  hydrodip::SheetOptions sheet;
  sheet.width_mm = options.film.width_mm;
  sheet.height_mm = options.film.height_mm;
  sheet.dpi = options.dpi;
  sheet.job_name = "example";
  const std::filesystem::path folder = argv[2];
  hydrodip::write_sheet(folder, made, printer, sheet);
  hydrodip::write_film(folder / "film.ply", *made.dipped.film);

  // What the object will look like, beside what was wanted.
  const hydrodip::Finish finish = hydrodip::finish(paint, {made}, printer);
  hydrodip::write_png(folder / "look.png", hydrodip::render(finish, 600));

  const hydrodip::Coverage& coverage = made.dipped.coverage;
  std::printf("rounds: %zu\n", made.ink.rounds.size());
  std::printf("covered: %.1f %% of what faces down\n", 100 * coverage.covered_downward_share());
  std::printf("largest stretch: %.2f\n", coverage.stretch_max);
} catch (const std::exception& error) {  // one sentence: what, where, how to mend
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
