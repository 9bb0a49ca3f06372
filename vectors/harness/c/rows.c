/* Tests a function against the rows of `ninebit vectors export --view c`, without a reader. With -DPLANT its rounding is one step off. */
#include "product.rows.h"
#include <stdio.h>
#ifdef PLANT
#define HALF 126
#else
#define HALF 127
#endif

/* A times B in steps of 1/255, rounded to the nearest, as a register. */
static int product(int a, int b)
{
    int n = (a * b + HALF + 255 * 1024) / 255 - 1024;
    return n < -256 ? -256 : n > 255 ? 255 : n;
}

int main(void)
{
    int failed = 0, count = sizeof product_rows / sizeof product_rows[0], n, got;
    for (n = 0; n < count; n++) {
        const struct product_row *row = &product_rows[n];
        if ((got = product(row->in_a, row->in_b)) != row->out_ab && failed++ == 0)
            printf("product: row %s (line %d of product.rows.inc): in.a=%d in.b=%d mid.product=%d out.ab=%d, found %d\n", row->id, n + 1,
                   row->in_a, row->in_b, (int)row->mid_product, row->out_ab, got);
    }
    printf("%d of %d rows failed\n", failed, count);
    return failed != 0;
}
