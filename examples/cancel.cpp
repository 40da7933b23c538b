// A job in a thread of its own, watched, and cancelled half way: cancel FOLDER
#include <hydrodip/hydrodip.h>

#include <cstdio>
#include <future>
#include <string>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::filesystem::path folder = argv[1];

  // A handle: copies stand for the same job. Whoever has one may cancel it, from any thread.
  const hydrodip::RunContext context;
  std::promise<void> half_dipped;
  bool told = false;
  context.on_progress([&](const std::string& activity, double fraction) {
    if (told || activity != "dipping" || fraction < 0.5) return;
    told = true;
    half_dipped.set_value();
  });

  auto job = std::async(std::launch::async, [&folder, context] {
    const hydrodip::Model model = hydrodip::sample("mask");
    const hydrodip::Printer printer = hydrodip::make_printer({});
    const hydrodip::Designed made =
        hydrodip::design(hydrodip::pose(model), *hydrodip::paint_of(model), {}, printer, context);
    hydrodip::write_sheet(folder, made, printer, {}, context);
  });

  half_dipped.get_future().wait();
  std::printf("half of the first dip is done\n");
  context.cancel();
  try {
    job.get();
    std::printf("too late, all of it is done\n");
  } catch (const hydrodip::Cancelled&) {
    const bool left = std::filesystem::exists(folder);
    std::printf("cancelled; %s\n", left ? "something was left behind" : "nothing was written");
  }
}
