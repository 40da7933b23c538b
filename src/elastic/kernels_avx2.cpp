// Compiled with AVX2 switched on (CMakeLists.txt).
#ifdef __AVX2__
#define KERNELS_VARIANT kAvx2
#define KERNELS_WIDTH 8
#include "elastic/kernels_body.h"
#endif
