" Colours of systems of agents.
if exists('b:current_syntax')
  finish
endif

syntax match agentspeaksystemName /\<\h\w*\ze\s*\(\[[^]]*\]\s*\)\?:/
syntax match agentspeaksystemAction /\.\@1<=\s*\h\w*/
syntax match agentspeaksystemTrigger /\.\@1<=[-+]!\?\s*\h\w*/
syntax match agentspeaksystemNumber /\<\d\+\>/
syntax match agentspeaksystemSection /\<\(agents\|channels\|properties\)\ze\_s*{/
syntax match agentspeaksystemSection /\<version\ze\_s\+\d/
syntax match agentspeaksystemSetting /\<\(capacity\|losses\|delay\)\ze\s*=/
syntax match agentspeaksystemFormula /\<\(never_together\|within\)\ze\_s*(/
syntax match agentspeaksystemAny /=\s*\zsany\>/
syntax match agentspeaksystemFile /:\s*\zs\S[^;:{}(]*\.conf\>/
syntax match agentspeaksystemComment +//.*$+ contains=@Spell
syntax region agentspeaksystemComment start=+/\*+ end=+\*/+ contains=@Spell

highlight default link agentspeaksystemName Identifier
highlight default link agentspeaksystemAction Function
highlight default link agentspeaksystemTrigger Structure
highlight default link agentspeaksystemNumber Number
highlight default link agentspeaksystemSection Keyword
highlight default link agentspeaksystemSetting Identifier
highlight default link agentspeaksystemFormula Statement
highlight default link agentspeaksystemAny Constant
highlight default link agentspeaksystemFile String
highlight default link agentspeaksystemComment Comment

let b:current_syntax = 'agentspeaksystem'
