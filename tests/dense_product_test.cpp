// SPDX-License-Identifier: BSD-3-Clause
// Dense products by CLBlast against Eigen's.
#include "host/device/dense_product.h"

#include <catch2/catch.hpp>

#include <Eigen/Dense>

#include "tests/shapes/shapes.h"

using namespace lcl;

#ifdef LIMITCL_CLBLAST

TEST_CASE("CLBlast's products are those of Eigen, written from an offset on", "[dense_product]") {
    using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const auto context = Context::create(choose_device());
    constexpr int rows = 21, inner = 20, columns = 4 * 33, offset = 12;
    shapes::Random random(3);
    Matrix a(rows, inner), b(inner, columns);
    for (Matrix* matrix : {&a, &b})
        for (Eigen::Index i = 0; i < matrix->size(); ++i) matrix->data()[i] = static_cast<float>(random.symmetric());
    std::vector<float> c(rows * columns + offset, 7);
    const Buffer on_a(context, a.size() * sizeof(float), "a", a.data()), on_b(context, b.size() * sizeof(float), "b", b.data()),
        on_c(context, c.size() * sizeof(float), "c", c.data());
    dense_product(*context, false, rows, inner, columns, on_a, on_b, on_c, offset);
    context->read(on_c, 0, c.size() * sizeof(float), c.data(), "reading c");
    CHECK(std::all_of(c.begin(), c.begin() + offset, [](float value) { return value == 7; }));
    const Matrix expected = a * b;
    // Sums of 20 products below 1: each of the two results is within 20 roundings of 2^-24 of the sum of their sizes.
    CHECK((Eigen::Map<const Matrix>(c.data() + offset, rows, columns) - expected).cwiseAbs().maxCoeff() < 2 * 20 * 20 * std::ldexp(1.0, -24));
}

#endif
