// hydrodip as a library: load -> pose -> simulate or design -> finish -> render, and files as a
// step of their own.
//
// Every step takes values and returns a value that nobody changes any more; copies share what is
// large, and what a value needs lives as long as the value. Lengths are millimetres, angles
// degrees. Every step may throw InputError (bad input: what, where, how to mend), DipError (the dip
// cannot be computed) or Cancelled. The same input gives the same values with any number of
// threads, and several jobs may run in one process.
//
//     const hydrodip::Model model = hydrodip::load("mask.obj");
//     const hydrodip::PosedObject posed = hydrodip::pose(model, {.size_mm = 160});
//     const hydrodip::Designed made = hydrodip::design(posed, *hydrodip::paint_of(model), {});
//
// The headers that this one includes say what the values hold.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "artwork/layer.h"
#include "base/context.h"
#include "base/error.h"
#include "coat/design.h"
#include "coat/finish.h"
#include "dip/trajectory.h"
#include "elastic/table_law.h"
#include "ink/printer.h"
#include "model_io/load.h"
#include "object/paint.h"
#include "object/posed_object.h"
#include "sheet/sheet.h"

namespace hydrodip {

// ---- load ----

// A model as its file has it, in millimetres.
struct Model {
  std::shared_ptr<const Object> object;      // the mesh and its colours
  MeshHealth health;                         // what was wrong with the mesh, and mended
  std::string units;                         // the unit that was applied
  std::vector<std::filesystem::path> files;  // every file that was read
};

// Reads OBJ, PLY, STL, OFF, 3MF, glTF, GLB with their pictures.
Model load(const std::filesystem::path& file, const LoadOptions& options = {},
           const RunContext& context = {});

// From arrays. Throws InputError for indices out of range and coordinates that are not finite.
Model model_from(Object object);

// A built-in sample: "sphere", "pyramid", "ellipsoid", "mask", "box", ...
Model sample(const std::string& name);

// The model's own colours over the bare object's (linear light).
std::shared_ptr<const Paint> paint_of(const Model& model, const LinearColor& base = {1, 1, 1, 1});

// The same under layers of artwork, the bottom one first, as they lie on the object in that pose (a
// pose matters only to layers that leave open from where they come). `dpi`, `samples_per_axis`: of
// what will be printed, to which drawings are matched.
std::shared_ptr<const Paint> paint_with(const Model& model, const PosedObject& posed,
                                        const std::vector<ArtworkLayer>& layers,
                                        const LinearColor& base = {1, 1, 1, 1}, double dpi = 300,
                                        int samples_per_axis = 3, const RunContext& context = {});

// ---- pose ----

// How the object hangs over the bath.
PosedObject pose(const Model& model, const PoseOptions& options = {});

// ---- simulate ----

// A dip of film with even stiffness, or with that of `modulus` (DipOptions).
struct SimulationOptions {
  FilmOptions film;              // its size and its mesh
  TrajectoryOptions trajectory;  // the object's way into the water
  DipOptions dip;                // with the film's material
  AirOptions air;                // how finely trapped air is looked for
};

// Where the film goes. `observe` sees every step, on the calling thread.
DippedObject simulate(const PosedObject& posed, const SimulationOptions& options,
                      const RunContext& context = {}, const DipObserver& observe = {});

// ---- design ----

// What to print so that every colour lands where `paint` has it. `allotment`: the part of it that
// this dip is to bring, where there are several.
Designed design(const PosedObject& posed, const Paint& paint, const DesignOptions& options,
                const Printer& printer = make_printer({}), const RunContext& context = {},
                const Allotment& allotment = Allotment());

// ---- finish ----

// One design after the other on the same object.
Finish finish(std::shared_ptr<const Paint> paint, const std::vector<Designed>& designs,
              const Printer& printer = make_printer({}));

// ---- render ----

// Wanted beside predicted, from the two most telling directions; `width_px` wide.
Image render(const Finish& finish, int width_px = 1600, const RunContext& context = {});

// ---- write ----

// print.png, print.tif and print.pdf in the folder. All appear, or none.
void write_sheet(const std::filesystem::path& folder, const Designed& designed,
                 const Printer& printer, const SheetOptions& options,
                 const RunContext& context = {});

// Any picture as PNG; the file appears whole or not at all.
void write_png(const std::filesystem::path& file, const Image& image);

// Binary PLY of the film after the dip; the file appears whole or not at all.
void write_film(const std::filesystem::path& file, const DippedFilm& film);

}  // namespace hydrodip
