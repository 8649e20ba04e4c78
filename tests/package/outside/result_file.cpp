// Writes a result file and reads it back; the one argument is its path.
#include <easydyn/results/result_file.hpp>

using namespace easydyn::results;

int main(int, char** argv) {
  const Eigen::Vector3d written(1, 2, 3);
  ResultFile file(argv[1], {.program = "result_file", .command = "", .convention = "none"});
  file.write_vector("/numbers", written, {"1", "three numbers", "none"});
  file.commit();
  return ResultReader(argv[1]).read_vector("/numbers") == written ? 0 : 1;
}
