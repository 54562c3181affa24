local t = {}
for i = 0, 1e6 - 1 do
  local a, b = {i, 1, 2}, {1, 2, 3}
  t[#t + 1] = {a[1] + b[1], a[2] + b[2], a[3] + b[3]}
end
print(#t)
