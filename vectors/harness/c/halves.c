/* Prints the column out.x of the table on standard input: twice each number, and the number; then why the reading ended.
 * vectors/harness/check holds the reader's numbers to it.
 */
#include "ninebit_vectors.h"

int main(void)
{
    static ninebit_table table;
    int column;
    if (!ninebit_open(&table, stdin)) {
        puts(table.error);
        return 2;
    }
    column = ninebit_column(&table, "out.x");
    while (ninebit_next(&table)) {
        printf("%s %ld", table.fields[0], ninebit_halves(&table, column));
        printf(" %ld\n", ninebit_number(&table, column));
        if (table.error[0]) ninebit_print(&table, stdout);
    }
    printf("%s\n", table.error[0] ? table.error : "end");
    return 0;
}
