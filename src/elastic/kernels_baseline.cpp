// For every processor: SSE2 on x86-64, NEON on arm64.
#define KERNELS_VARIANT kBaseline
#define KERNELS_WIDTH 4
#include "elastic/kernels_body.h"
