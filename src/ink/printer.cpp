#include "ink/printer.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/file.h"
#include "ink/rgb_profile.h"

namespace hydrodip {

Printer make_printer(const PrinterOptions& options) {
  Printer printer;
  printer.options = options;
  printer.profile_file = options.profile;
  if (printer.profile_file.empty() && options.model == InkModel::kDevice) {
    printer.model = make_device_model();
    return printer;
  }
  if (printer.profile_file.empty()) printer.profile_file = installed_cmyk_profile();
  if (printer.profile_file.empty())
    throw InputError(
        "ink.model: no CMYK profile is installed on this machine; name one with --printer-profile, "
        "install Debian's libgs-common, or set ink.model=device");
  const std::string name = printer.profile_file.string();
  printer.profile_bytes = read_file(printer.profile_file);
  printer.is_rgb = is_rgb_profile(printer.profile_bytes);
  if (!printer.is_rgb) {
    printer.model = make_profile_model(printer.profile_bytes, name, options.intent);
    return printer;
  }
  // Which inks its printer makes of a colour, an RGB profile does not say.
  if (options.color == PrintColor::kCmyk)
    throw InputError(fmt::format(
        "{}: is the profile of an RGB printer; set print.color=rgb, or name a CMYK profile", name));
  printer.model = make_device_model();
  return printer;
}

}  // namespace hydrodip
