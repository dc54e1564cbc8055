/// RowLoops compiled for processors with AVX2.

#include "judge/row_loops_lanes.hpp"

namespace routebench::judging {

const RowLoops kAvx2Loops = kLoops;

}  // namespace routebench::judging
