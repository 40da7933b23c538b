// Writes the seeds of all targets: FOLDER/TARGET/FILE.
#include <cstdio>
#include <filesystem>

#include "base/file.h"
#include "image/files.h"
#include "model_io/model_files.h"

using namespace hydrodip;
namespace fs = std::filesystem;

namespace {

void write(const fs::path& path, const fixtures::Bytes& bytes) {
  fs::create_directories(path.parent_path());
  write_file(path, bytes.data(), bytes.size());
}

fixtures::Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  const fs::path to = arguments[1];
  write(to / "obj/a", bytes_of(fixtures::obj_text()));
  write(to / "mtl/a", bytes_of(fixtures::mtl_text()));
  write(to / "mtl/b", bytes_of("newmtl a\nKd 1 1 1\nTr 1\nd -halo 0.5\n"
                               "map_Kd -s 2 2 1 -o .5 0 0 -mm 0 1 -clamp on a.png\n"));
  write(to / "ply/a", bytes_of(fixtures::ascii_ply_text()));
  write(to / "ply/b", fixtures::binary_ply(false));
  write(to / "ply/c", fixtures::binary_ply(true));
  write(to / "ply/d", bytes_of("ply\nformat ascii 1.0\ncomment TextureFile a.png \n"
                               "element vertex 3\nproperty float x\nproperty float y\n"
                               "property float z\nelement face 1\n"
                               "property list uchar int vertex_indices\n"
                               "property list uchar float texcoord\nproperty int texnumber\n"
                               "property uchar red\nend_header\n"
                               "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 6 0 0 1 0 0 1 0 255\n"));
  write(to / "stl/a", bytes_of(fixtures::ascii_stl_text()));
  write(to / "stl/b", fixtures::binary_stl());
  write(to / "off/a", bytes_of(fixtures::off_text()));
  write(to / "off/b", bytes_of(fixtures::coff_text()));
  write(to / "gltf/a", fixtures::glb());
  write(to / "gltf/b", bytes_of(fixtures::gltf_text()));
  write(to / "threemf/a", fixtures::threemf("inch"));
  write(to / "mesh/a", bytes_of("5abcdefghijklmnopqrstuvwxyzabcdefghijklmnopqrstuvwxyz"));
  const Image image = [] {
    Image made(5, 4);
    for (std::size_t i = 0; i < made.rgba.size(); ++i) made.rgba[i] = std::uint8_t(37 * i);
    return made;
  }();
  write(to / "picture/png", encode_png(image, 300));
  write(to / "picture/jpeg", encode_jpeg(image, 80));
  write(to / "settings/a", bytes_of("[film]\nwidth_mm = 210\nshape = \"disc\"\n"
                                    "[object]\nrotate_deg = [1, 2.5, 3]\nprint.dpi = 1e2\n"));
  write(to / "scan/a",
        bytes_of("\x30"
                 "column,row,x,y,z\n0,0,0,0,0\n1,0,10,0,0\n0,1,0,10,0\n1,1,10,10,0\n"));
  const auto record = [&](int kind, const std::string& text) {
    write(to / "record" / std::to_string(kind), bytes_of(char('0' + kind % 10) + text));
  };
  // '0' is 48, so kind k of the target has the sign '0' + (k + 2) % 10.
  record(2, R"({"title":"a","inputs":[{"role":"model","path":"a.obj","sha256":"0"}],"parameters":
{"film.width_mm":{"value":210},"film.shape":{"value":"disc"},"object.rotate_deg":{"value":[1,2,3]}},
"figures":{"depth_mm":12.5,"object_size_mm":[1,2,3]},"ink":{"mean":{"cyan":0.5}},"warnings":["b"],
"dip_of_several":{"number":1,"of":2},"way_in":[{"travelled_mm":1,"lower_mm":1,"shift_x_mm":0,
"shift_y_mm":0,"turn_x_deg":0,"turn_y_deg":0,"turn_z_deg":0}]})");
  record(3, R"({"photo_px":[640,480],"lens_focal_center_k1_k2_p1_p2":[500,320,240,0,0,0,0],
"lens_covariance":[1,0,0,0,0,0,0,0,1,0,0,0,0,0,0,0,1,0,0,0,0,0,0,0,1,0,0,0,0,0,0,0,1,0,0,0,0,0,0,0,1,0,0,0,0,0,0,0,1],"place_x_y_mm_turn_deg":[0,0,0],"water_below_mm":22,"board_tag_x_y_z_mm":[[1,2,3,4]]})");
  record(
      4,
      R"({"shift_mm":{"x":1,"y":2},"turn_deg":{"value":0.1},"swelling":{"x":1.02,"y":1.01},"photo":{"sha256":"0"}})");
  record(
      5,
      R"({"grid":{"first_mm":[0,0],"pitch_mm":5,"nx":2,"ny":2,"move_mm":[[0,1],[1,0],[0,0],[1,1]]}})");
  record(6,
         "lower_mm,shift_x_mm,shift_y_mm,turn_x_deg,turn_y_deg,turn_z_deg\n0,0,0,0,0,0\n9,1,0,0,0,"
         "5\n");
  record(7, "film_x_mm,film_y_mm,x,y,z\n1,2,3,4,5\n");
  record(8,
         "{\"event\":\"start\",\"depth_mm\":1,\"time\":\"2026\"}\n{\"event\":\"end\",\"outcome\":"
         "\"done\"}\n");
  record(
      9,
      R"({"hydrodip_sweep":2,"command":"simulate","quality":"draft","job":"","keep":"all","varied":["a"],
"inputs":{"a.obj":"00"},"model_files":{"a.obj":["a.obj","a.mtl"]},
"runs":[{"id":"0123456789abcdef","model":"a","values":{"a":"1"}}]})");
  record(1, R"({"id":"0123456789abcdef","seconds":1,"report":{"concern":"none"}})");
  write(to / "scan/b", bytes_of("\x31v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nf 1 2 3 4\n"));
  write(to / "store/a", bytes_of("{\"subject\":\"a-1\",\"z_stretch\":0.5,\"ink_stiffness_ratio\":9,"
                                 "\"poisson\":0,\"film_mm\":[[1,2],null]}\n"));
}
