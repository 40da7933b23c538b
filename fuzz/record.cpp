// What hydrodip wrote itself and reads again, which anybody may have changed since.
#include "base/error.h"
#include "calibrate/measured_dip.h"
#include "history/run_log.h"
#include "register/place_table.h"
#include "register/tank_file.h"
#include "rig/registration_file.h"
#include "rig/rig_job.h"
#include "settings/correction_file.h"
#include "settings/path_file.h"
#include "sweep/sweep_manifest.h"
#include "sweep/sweep_run.h"
#include "through_file.h"

using namespace hydrodip;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  // The first byte says which kind.
  const auto file = [&](const char* name) { return fuzz::file_with(name, data + 1, size - 1); };
  const char* id = "0123456789abcdef.json";
  try {
    switch (data[0] % 10) {
      case 0:
        load_rig_job(file("report.json").parent_path(), {});
        break;
      case 1:
        read_tank(file("camera.json"));
        break;
      case 2:
        read_registration(file("registration.json"));
        break;
      case 3:
        read_correction(file("correction.json"));
        break;
      case 4:
        read_path(file("path.csv"));
        break;
      case 5:
        read_place_table(file("places.csv"));
        break;
      case 6:
        read_run_log(file("log.jsonl").parent_path());
        break;
      case 7:
        read_manifest(file("sweep.json").parent_path());
        break;
      case 8:
        read_measured_dip(file("dip.zip"));
        break;
      case 9: {
        const std::filesystem::path folder = file(id).parent_path();
        std::error_code ignored;
        std::filesystem::create_directory(folder / "runs", ignored);
        std::filesystem::rename(folder / id, folder / "runs" / id, ignored);
        read_outcome(folder, "0123456789abcdef");
        break;
      }
    }
  } catch (const InputError&) {
  }
  return 0;
}
