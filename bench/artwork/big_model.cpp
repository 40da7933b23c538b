// What artwork on a model without UVs costs beside the same job with UVs and a texture, which an
// OBJ and a binary PLY have: whole print jobs of a bumpy ellipsoid. `bench_artwork [TRIANGLES
// [SIDE_PX]]`; 2 million triangles and a picture of 10000 x 10000 px unless told. Processor time,
// so that other programs do no harm; each job's own peak of memory.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <numbers>

#include "base/file.h"
#include "image/files.h"
#include "job/jobs.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

constexpr double kSize_mm = 104;  // of the picture; the model is 100 mm wide

// Rows of a ball, bumpy, from the pole that enters the water first.
class Ellipsoid {
 public:
  explicit Ellipsoid(int triangles)
      : rows_(std::max(4, int(std::sqrt(triangles / 4.0)))), columns_(2 * rows_) {}

  Eigen::Vector3f at(int column, int row) const {
    const double theta = std::numbers::pi * row / rows_;
    const double phi = 2 * std::numbers::pi * (column % columns_) / columns_;
    const double bump = 1 + 0.02 * std::sin(9 * phi) * std::sin(7 * theta) * std::sin(theta);
    const double out = row == 0 || row == rows_ ? 0 : std::sin(theta);
    return {float(50 * bump * out * std::cos(phi)), float(40 * bump * out * std::sin(phi)),
            float(-30 * bump * std::cos(theta))};
  }

  // visit(three corners as (column, row)).
  template <class Visit>
  void each_triangle(const Visit& visit) const {
    using Corner = std::pair<int, int>;
    for (int j = 0; j < rows_; ++j)
      for (int i = 0; i < columns_; ++i) {
        const Corner a(i, j), b((i + 1) % columns_, j), c((i + 1) % columns_, j + 1), d(i, j + 1);
        if (j > 0) visit(a, b, c);
        if (j + 1 < rows_) visit(a, c, d);
      }
  }

  std::string stl() const {
    std::string bytes(84, ' ');
    std::uint32_t count = 0;
    each_triangle([&](auto... corner) {
      std::array<float, 12> numbers{};
      std::size_t k = 3;
      for (const auto& [column, row] : {corner...}) {
        const Eigen::Vector3f p = at(column, row);
        std::memcpy(&numbers[k], p.data(), sizeof(float) * 3);
        k += 3;
      }
      bytes.append(reinterpret_cast<const char*>(numbers.data()), sizeof numbers);
      bytes.append(2, '\0');
      ++count;
    });
    std::memcpy(&bytes[80], &count, sizeof count);
    return bytes;
  }

  // With UVs as a planar picture from below would have them.
  std::string obj() const {
    std::string text = "mtllib big.mtl\nusemtl big\n";
    auto out = std::back_inserter(text);
    for (int j = 0; j <= rows_; ++j)
      for (int i = 0; i < columns_; ++i) {
        const Eigen::Vector3f p = at(i, j);
        fmt::format_to(out, "v {:.5f} {:.5f} {:.5f}\nvt {:.6f} {:.6f}\n", p.x(), p.y(), p.z(),
                       0.5 - p.x() / kSize_mm, 0.5 + p.y() / kSize_mm);
      }
    each_triangle([&](auto... corner) {
      text += 'f';
      for (const auto& [column, row] : {corner...}) {
        const int v = row * columns_ + column + 1;
        fmt::format_to(out, " {}/{}", v, v);
      }
      text += '\n';
    });
    return text;
  }

  // The same UVs, binary: as quick to read as the STL.
  std::string ply() const {
    std::size_t count = 0;
    each_triangle([&](auto...) { ++count; });
    std::string bytes = fmt::format(
        "ply\nformat binary_little_endian 1.0\ncomment TextureFile big.png\nelement vertex {}\n"
        "property float x\nproperty float y\nproperty float z\nproperty float s\nproperty float t\n"
        "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        (rows_ + 1) * columns_, count);
    for (int j = 0; j <= rows_; ++j)
      for (int i = 0; i < columns_; ++i) {
        const Eigen::Vector3f p = at(i, j);
        const std::array<float, 5> numbers = {p.x(), p.y(), p.z(), float(0.5 - p.x() / kSize_mm),
                                              float(0.5 + p.y() / kSize_mm)};
        bytes.append(reinterpret_cast<const char*>(numbers.data()), sizeof numbers);
      }
    each_triangle([&](auto... corner) {
      bytes += char(3);
      for (const auto& [column, row] : {corner...}) {
        const std::int32_t v = row * columns_ + column;
        bytes.append(reinterpret_cast<const char*>(&v), sizeof v);
      }
    });
    return bytes;
  }

 private:
  int rows_, columns_;
};

Image picture(int side_px) {
  Image image(side_px, side_px);
  for (int y = 0; y < side_px; ++y)
    for (int x = 0; x < side_px; ++x) {
      std::uint8_t* pixel = image.pixel(x, y);
      pixel[0] = std::uint8_t(x / 16 * 37);
      pixel[1] = std::uint8_t(y / 16 * 23);
      pixel[2] = std::uint8_t((x + y) / 64 * 11);
      pixel[3] = 255;
    }
  return image;
}

struct Cost {
  double processor_s, peak_gb;
};

Cost cost_of(const JobConfig& config) {
  // From here on (Linux), so that no job answers for those before it.
  if (std::FILE* file = std::fopen("/proc/self/clear_refs", "w")) {
    std::fputs("5", file);
    std::fclose(file);
  }
  const std::clock_t begin = std::clock();
  print_job(config, RunContext());
  return {double(std::clock() - begin) / CLOCKS_PER_SEC, double(peak_memory_bytes()) / 1e9};
}

void run(int triangles, int side_px) {
  const TemporaryFolder folder;
  const Ellipsoid ellipsoid(triangles);
  write_file(folder.path() / "big.stl", ellipsoid.stl());
  write_file(folder.path() / "big.obj", ellipsoid.obj());
  write_file(folder.path() / "big.ply", ellipsoid.ply());
  write_file(folder.path() / "big.mtl", "newmtl big\nKd 1 1 1\nmap_Kd big.png\n");
  save_png(folder.path() / "big.png", picture(side_px));

  JobConfig config;
  config.design.film.width_mm = 200;
  config.design.film.height_mm = 180;
  config.design.film.elements = 10000;
  config.design.dip.step_mm = 1;
  config.design.rounds_max = 2;
  config.design.trajectory.depth_mm = 25;
  config.output = folder.path() / "out";
  JobConfig with_artwork = config;
  with_artwork.model = folder.path() / "big.stl";
  with_artwork.object.artwork.emplace_back();
  with_artwork.object.artwork[0].image = folder.path() / "big.png";
  with_artwork.object.artwork[0].width_mm = kSize_mm;
  const Cost artwork = cost_of(with_artwork);
  fmt::print("STL and artwork: {:.1f} s of processor time, {:.2f} GB\n", artwork.processor_s,
             artwork.peak_gb);
  for (const char* name : {"big.ply", "big.obj"}) {
    config.model = folder.path() / name;
    const Cost uvs = cost_of(config);
    fmt::print("{} with UVs: {:.1f} s, {:.2f} GB; artwork takes {:.2f} times as long\n", name,
               uvs.processor_s, uvs.peak_gb, artwork.processor_s / uvs.processor_s);
  }
}

}  // namespace
}  // namespace hydrodip

int main(int argc, char** argv) {
  hydrodip::run(argc > 1 ? std::atoi(argv[1]) : 2000000, argc > 2 ? std::atoi(argv[2]) : 10000);
}
