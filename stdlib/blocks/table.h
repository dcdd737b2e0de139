// blocks/table.h: a curve through points, straight between them.
// Names: TABLE_BLOCK the structure (Table), TABLE_STEP the function (StepTable). docs/reference/blocks.md says how names are given.
//
//   in      in   x, any value
//   first   in   number of the first variable of the points: x, y, x, y, ...
//   points  in   how many there are   2 and more
//   out     out  y; before the first point the first y, behind the last one the last y
//   at      own  number of the x at the left of in: the search goes on from there
//   last    own  the last number that at may have
//   width, height, way   own
//
// The x of the points rise, from one to the next by 46340 at most; the y change by 2147483647 at most. Rounded to the y of the
// left point. The unit is the program's.
#ifndef BLOCKS_TABLE_H
#define BLOCKS_TABLE_H
typedef struct { long in; long first; long points; long out; long at; long last; long width; long height; long way; } TableBlock;
#endif
#ifndef TABLE_BLOCK
#define TABLE_BLOCK Table
#endif
#ifndef TABLE_STEP
#define TABLE_STEP StepTable
#endif

TableBlock TABLE_BLOCK;

// height * way / width needs up to 63 bits. With height = q * width + r it is q * way + r * way / width, and r and way are
// less than the width.
TABLE_STEP()
{
    TABLE_BLOCK.last = TABLE_BLOCK.first + TABLE_BLOCK.points * 2 - 4;
    if (TABLE_BLOCK.at < TABLE_BLOCK.first || TABLE_BLOCK.at > TABLE_BLOCK.last)
        TABLE_BLOCK.at = TABLE_BLOCK.first;
    while (TABLE_BLOCK.at > TABLE_BLOCK.first && *(TABLE_BLOCK.at) > TABLE_BLOCK.in)
        TABLE_BLOCK.at -= 2;
    while (TABLE_BLOCK.at < TABLE_BLOCK.last && *(TABLE_BLOCK.at + 2) < TABLE_BLOCK.in)
        TABLE_BLOCK.at += 2;
    if (*(TABLE_BLOCK.at) >= TABLE_BLOCK.in)
    {
        TABLE_BLOCK.out = *(TABLE_BLOCK.at + 1);
        return;
    }
    if (*(TABLE_BLOCK.at + 2) <= TABLE_BLOCK.in)
    {
        TABLE_BLOCK.out = *(TABLE_BLOCK.at + 3);
        return;
    }
    TABLE_BLOCK.way = TABLE_BLOCK.in - *(TABLE_BLOCK.at);
    TABLE_BLOCK.width = *(TABLE_BLOCK.at + 2) - *(TABLE_BLOCK.at);
    TABLE_BLOCK.height = *(TABLE_BLOCK.at + 3) - *(TABLE_BLOCK.at + 1);
    TABLE_BLOCK.way = TABLE_BLOCK.height / TABLE_BLOCK.width * TABLE_BLOCK.way
        + TABLE_BLOCK.height % TABLE_BLOCK.width * TABLE_BLOCK.way / TABLE_BLOCK.width;
    TABLE_BLOCK.out = *(TABLE_BLOCK.at + 1) + TABLE_BLOCK.way;
}

#undef TABLE_BLOCK
#undef TABLE_STEP
