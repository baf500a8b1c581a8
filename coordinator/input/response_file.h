// A frequency response matrix as a CSV: what `fatmc estimate` writes as frm.csv.
//
//   line,frequency_hz,output,input,re,im[,...]     a row an element and frequency, in any order; further
//   columns ignored
#pragma once

#include <complex>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/ident/matrix_stack.h"

namespace fatmc {

struct ResponseTable {
  std::vector<std::string> outputs, inputs;    ///< in the order in which they appear
  std::vector<double> frequency_hz;            ///< ascending
  MatrixStack<std::complex<double>> response;  ///< outputs × inputs at each frequency
};

/// The error names the line and column of what is missing, there twice, or not a finite number.
Result<ResponseTable> read_response_table(const std::string& path);

/// The table's responses from `inputs` to `outputs`, in their order; the error names a channel that it lacks.
/// `path` goes into it.
Result<MatrixStack<std::complex<double>>> matching_response(const ResponseTable& table,
                                                            const std::vector<std::string>& outputs,
                                                            const std::vector<std::string>& inputs,
                                                            const std::string& path);

}  // namespace fatmc
