/// RowLoops compiled for processors with AVX-512 that convert and count whole words (DQ,
/// VPOPCNTDQ).

#include "judge/row_loops_lanes.hpp"

namespace routebench::judging {

const RowLoops kAvx512Loops = kLoops;

}  // namespace routebench::judging
