local t = {}
for i = 0, 1e7 - 1 do t[#t + 1] = i + 1 end
print(#t)
