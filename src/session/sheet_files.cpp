#include "session/sheet_files.h"

#include "ink/rgb_profile.h"

namespace hydrodip {
namespace {

// For the printer's own RGB where its profile is given, else in sRGB.
void write_rgb_pdf(const std::filesystem::path& path, const Image& look, const Printer& printer,
                   const SheetOptions& options, const RunContext& context) {
  if (!printer.is_rgb) return write_print_pdf(path, look, srgb_profile(), options, context);
  const Image in_rgb = in_printer_rgb(look, printer.profile_bytes, printer.profile_file.string(),
                                      printer.options.intent);
  write_print_pdf(path, in_rgb, printer.profile_bytes, options, context);
}

}  // namespace

void write_sheet_files(OutputFolder& folder, const FilmInk& ink, const Printer& printer,
                       const SheetOptions& options, const RunContext& context,
                       const std::string& inside) {
  RunContext job = context;
  const ColorModel& model = *printer.model;
  const InkImage& inks = ink.inking.inks;
  const Image look = look_on_film(inks, ink.wanted, model);
  const auto png = folder.path(inside + "print.png"), tiff = folder.path(inside + "print.tif"),
             pdf = folder.path(inside + "print.pdf");
  context.side_by_side("writing the sheet",
                       {[&] { write_print_tiff(tiff, inks, model.profile(), options); },
                        [&] {
                          if (printer.options.color == PrintColor::kCmyk)
                            write_print_pdf(pdf, inks, model.profile(), options, job);
                          else
                            write_rgb_pdf(pdf, look, printer, options, job);
                        },
                        [&] { write_print_png(png, look, options); }});
}

}  // namespace hydrodip
