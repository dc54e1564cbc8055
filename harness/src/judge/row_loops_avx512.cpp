/// RowLoops compiled for processors with AVX-512.

#include "judge/row_loops_lanes.hpp"

namespace routebench::judging {

const RowLoops kAvx512Loops = kLoops;

}  // namespace routebench::judging
