// A dip that somebody made and measured, in one file: the scanned corners with all that has to be
// known to compute against them. docs/measured-dips.md describes it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "film/film.h"
#include "scan/board.h"
#include "scan/read_scan.h"

namespace hydrodip {

// What only who dipped can tell. The first ones are asked for.
struct DipFacts {
  std::string film, printer, ink, activator;  // products
  std::optional<double> water_c, soak_s, activator_g, wait_s;
  std::string owner, licence;  // an SPDX identifier, as CC-BY-4.0
  std::optional<double> speed_mm_per_min;
  std::string dipped_on;  // 2026-11-27
  std::string notes;
};

// Throws InputError that names every option that is missing, or one that no dip can have.
void require_facts(const DipFacts& facts);

struct MeasuredDip {
  std::string object;  // a shape that has a name
  double depth_mm = 0;
  Board board;
  FilmOptions film;           // only what the sheet is: extents, margin, shape, swelling
  bool says_swelling = true;  // archives of before schema version 2 do not
  DipFacts facts;
  Scan scan;                         // mm, turned back if it was mirrored
  std::string scan_file;             // the owner's, its name in the archive
  std::vector<std::uint8_t> source;  // its bytes
};

// Whether a word of a command line names such a file.
bool is_measured_dip(const std::string& text);

// Throws InputError, naming the file, for what is none, is damaged or was changed since, or says
// something that cannot be.
MeasuredDip read_measured_dip(const std::filesystem::path& file);

// The same bytes for the same dip. Throws InputError if it cannot be written.
void write_measured_dip(const std::filesystem::path& file, const MeasuredDip& dip);

}  // namespace hydrodip
