local result, columns, rising, falling, place = 0, {}, {}, {}, {}
for n = 0, 15 do columns[n], rising[n], falling[n] = 0, 0, 0 end
for round = 1, 60 do
  local row = 0
  place[0] = -1
  while row >= 0 do
    local column = place[row]
    if column >= 0 then
      columns[column] = 0
      rising[row + column] = 0
      falling[row - column + 7] = 0
    end
    local free_place = false
    column = column + 1
    while column < 8 and not free_place do
      free_place = columns[column] | rising[row + column] | falling[row - column + 7] == 0
      column = column + 1
    end
    if not free_place then
      row = row - 1
    else
      column = column - 1
      place[row] = column
      columns[column] = 1
      rising[row + column] = 1
      falling[row - column + 7] = 1
      if row == 7 then
        result = result + 1
      else
        row = row + 1
        place[row] = -1
      end
    end
  end
end
print(result)
