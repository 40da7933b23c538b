#include "export/stl.h"

#include "base/file.h"
#include "export/bytes.h"

namespace hydrodip {

void write_stl(const std::filesystem::path& file, const TriangleMesh& mesh,
               const std::string& title) {
  constexpr std::size_t kHeader = 80;
  Bytes out;
  std::string header = title.substr(0, kHeader);
  header.resize(kHeader, ' ');
  out.add(header);
  out.add_u32(std::uint32_t(mesh.triangles.size()));
  const auto add = [&](const Vec3& v) {
    for (int k = 0; k < 3; ++k) out.add_f32(float(v[k]));
  };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    add(face_normal(mesh, int(t)));
    for (const std::int32_t v : mesh.triangles[t]) add(mesh.positions[std::size_t(v)]);
    out.add_u8(0);
    out.add_u8(0);
  }
  write_file(file, out.data().data(), out.data().size());
}

}  // namespace hydrodip
