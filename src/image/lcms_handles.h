// Little CMS's handles, which are closed when they go out of scope.
#pragma once

#include <lcms2.h>

#include <memory>
#include <type_traits>

namespace hydrodip::lcms {

struct CloseContext {
  void operator()(cmsContext context) const { cmsDeleteContext(context); }
};
struct CloseProfile {
  void operator()(cmsHPROFILE profile) const { cmsCloseProfile(profile); }
};
struct CloseTransform {
  void operator()(cmsHTRANSFORM transform) const { cmsDeleteTransform(transform); }
};
// Without a context of its own, Little CMS would report errors through a global.
using Context = std::unique_ptr<std::remove_pointer_t<cmsContext>, CloseContext>;
// Both handles are void*.
using Profile = std::unique_ptr<void, CloseProfile>;
using Transform = std::unique_ptr<void, CloseTransform>;

}  // namespace hydrodip::lcms
