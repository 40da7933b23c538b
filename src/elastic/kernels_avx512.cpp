// Compiled with AVX-512 switched on (CMakeLists.txt).
#ifdef __AVX512F__
#define KERNELS_VARIANT kAvx512
#define KERNELS_WIDTH 16
#include "elastic/kernels_body.h"
#endif
