#include "session/sheet_files.h"
#include "ink/discoloration.h"

#include <functional>
#include <utility>
#include <vector>

#include "ink/rgb_profile.h"

namespace hydrodip {

// One after the other, as far as one takes the place of another in memory: the inks, what they look
// like, and that in the printer's own red, green and blue, if there is such a profile.
void write_sheet_files(OutputFolder& folder, InkImage inks, const PixelSet& printed,
                       const Printer& printer, const SheetOptions& options,
                       const RunContext& context, const std::string& inside) {
  const std::string activity = "writing the sheet";
  const ColorModel& model = *printer.model;
  const bool pdf_of_inks = printer.options.color == PrintColor::kCmyk;
  const bool pdf_in_srgb = !pdf_of_inks && !printer.is_rgb;
  const auto png = folder.path(inside + "print.png"), tiff = folder.path(inside + "print.tif"),
             pdf = folder.path(inside + "print.pdf");
  const auto write_pdf = [&](const Picture& picture, const std::vector<std::uint8_t>& profile) {
    write_print_pdf(pdf, picture, profile, options, context);
  };

  std::vector<std::function<void()>> of_inks{
      [&] { write_print_tiff(tiff, inks, model.profile(), options); }};
  if (pdf_of_inks) of_inks.emplace_back([&] { write_pdf(inks, model.profile()); });
  context.side_by_side(activity, of_inks);

  Image look = look_on_film(std::move(inks), printed, model);
  std::vector<std::function<void()>> of_look{[&] { write_print_png(png, look, options); }};
  if (pdf_in_srgb) of_look.emplace(of_look.begin(), [&] { write_pdf(look, srgb_profile()); });
  context.side_by_side(activity, of_look);

  if (pdf_of_inks || pdf_in_srgb) return;
  write_pdf(in_printer_rgb(std::move(look), printer.profile_bytes, printer.profile_file.string(),
                           printer.options.intent),
            printer.profile_bytes);
}

}  // namespace hydrodip
