// Scan in: the checkerboard's corners on the object, from a quad mesh or a table.
#pragma once

#include <filesystem>
#include <string>

#include "base/context.h"
#include "scan/corner_grid.h"

namespace hydrodip {

struct ScanOptions {
  // Of the file: mm, cm, m or in. Empty: what the format says, as glTF's metres, else mm.
  std::string units = {};
  double square_mm = 5;   // as printed, to check the unit by
  bool mirrored = false;  // the file is a mirror image: turn it back
};

struct Scan {
  CornerGrid grid;  // mm, in the scan's own frame
  // The file says that it was computed, not scanned.
  bool synthetic = false;
};

// OBJ or PLY: faces with four corners each. CSV or TXT: a line per corner "column,row,x,y,z", with
// commas, semicolons, blanks or tabs between; other lines must begin with '#' or name the columns.
// Throws InputError for what is no grid of at least 4 corners, and where the corners' distances say
// that the unit is wrong.
Scan read_corner_scan(const std::filesystem::path& file, const ScanOptions& options,
                      const RunContext& context);

// The same, and also scans with their colours, in any format of models that has such: triangles
// with a texture or coloured vertices, on which the corners of dark squares are found (of a board
// on which these touch no other: dark_squares.h). Throws InputError if it shows too few.
Scan read_scan(const std::filesystem::path& file, const ScanOptions& options,
               const RunContext& context);

// The first line of a computed scan, after its '#'.
extern const char* const kSyntheticMark;

// The forms that read_scan takes, for scans that are computed. Places are written from 0 on.
void write_scan_table(const std::filesystem::path& file, const CornerGrid& grid,
                      const std::string& comment);
// Only corners of whole squares.
void write_scan_quads(const std::filesystem::path& file, const CornerGrid& grid,
                      const std::string& comment);

}  // namespace hydrodip
