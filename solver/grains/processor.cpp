// Which of the kernels this processor can run.
#include "solver/grains/grain_kernels.hpp"

namespace bedload {

bool runs_v4() { return __builtin_cpu_supports("x86-64-v4"); }

const GrainKernels& grain_kernels() { return runs_v4() ? grain_kernels_v4 : grain_kernels_v3; }

}   // namespace bedload
