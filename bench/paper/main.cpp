// The paper's figures: `paper_figures [FOLDER [FIGURE...]]` writes pictures and Markdown tables.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <fstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "figures.h"

namespace hydrodip::paper {
namespace {

struct Figure {
  std::string name;
  std::string title;
  std::string (*make)(const Study&);
};

const std::vector<Figure>& figures() {
  static const std::vector<Figure> all = {
      {"figure_5", "Figure 5: ink pales on stretched film, and is made up for", figure_5},
      {"figure_6", "Figure 6: ink bends the lines of a checkerboard", figure_6},
      {"figure_7", "Figure 7: the printed image over the rounds", figure_7},
      {"figure_8", "Figure 8: a checkerboard on three shapes, and back", figure_8},
      {"figure_9", "Figure 9: three methods against the same truth", figure_9},
      {"table_1", "Table 1: calibration, on synthetic scans", table_1},
  };
  return all;
}

std::string known_names() {
  std::string names;
  for (const Figure& figure : figures()) names += (names.empty() ? "" : ", ") + figure.name;
  return names;
}

std::vector<Figure> chosen(const std::vector<std::string>& names) {
  if (names.empty()) return figures();
  std::vector<Figure> result;
  for (const std::string& name : names) {
    const auto found = std::find_if(figures().begin(), figures().end(),
                                    [&](const Figure& figure) { return figure.name == name; });
    if (found == figures().end())
      throw InputError(
          fmt::format("there is no figure '{}'; these there are: {}", name, known_names()));
    result.push_back(*found);
  }
  return result;
}

void make(const Figure& figure, const Study& study) {
  fmt::print("== {}\n", figure.title);
  std::fflush(stdout);
  const auto start = std::chrono::steady_clock::now();
  const std::string text = "## " + figure.title + "\n\n" + figure.make(study);
  std::ofstream(study.folder / (figure.name + ".md")) << text;
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
  fmt::print("{}\n({:.0f} s)\n\n", text, time.count());
  std::fflush(stdout);
}

int run(const std::vector<std::string>& arguments) {
  if (!arguments.empty() && arguments.front().starts_with("-"))
    throw InputError(
        fmt::format("usage: paper_figures [FOLDER [FIGURE...]]; the figures: {}", known_names()));
  const std::filesystem::path folder = arguments.empty() ? "out/paper" : arguments.front();
  const std::vector<std::string> names(arguments.begin() + (arguments.empty() ? 0 : 1),
                                       arguments.end());
  RunContext context;
  const std::vector<Figure> todo = chosen(names);
  std::filesystem::create_directories(folder);
  for (const Figure& figure : todo) make(figure, {folder, context});
  fmt::print("pictures and tables: {}\n", folder.string());
  return 0;
}

}  // namespace
}  // namespace hydrodip::paper

int main(int argc, char** argv) {
  try {
    return hydrodip::paper::run({argv + 1, argv + argc});
  } catch (const hydrodip::InputError& error) {
    fmt::print(stderr, "paper_figures: {}\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "paper_figures: {}\n", error.what());
    return 3;
  }
}
