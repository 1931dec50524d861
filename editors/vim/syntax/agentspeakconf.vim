" Colours of agents' configurations.
if exists('b:current_syntax')
  finish
endif

syntax match agentspeakconfName /\<\h\w*\ze\s*[(:]/
syntax match agentspeakconfTrigger /[-+]!\?\h\w*/
syntax match agentspeakconfNumber /\<\d\+\(\.\d\+\)\?\>/
syntax match agentspeakconfType /\<\h\w*_t\>/
syntax keyword agentspeakconfType void bool char short int long float double signed unsigned const struct
syntax match agentspeakconfSection /\<\(settings\|includes\|structs\|basics\|classes\|peers\|messages\|types\|settables\|perceived\|triggerables\|preemptive\|properties\)\ze\_s*{/
syntax match agentspeakconfSection /\<version\ze\_s\+\d/
syntax match agentspeakconfSetting /\<\(trace\|clock\|input\|output\|header\|basics\|rust\|matrix\|instance\|inbox\|max_events\)\ze\s*=/
syntax keyword agentspeakconfFormula exactly_one at_most_one at_least_one never within only_after all_handled unless until
syntax match agentspeakconfFormula /\<all\ze\_s\+\h\w*\_s\+but\>/
syntax match agentspeakconfFormula /\<but\ze\_s\+\h/
syntax match agentspeakconfFormula /\<\(tell\|achieve\)\ze\_s\+\h/
syntax match agentspeakconfFormula /\<from\ze\_s\+\h/
syntax match agentspeakconfFormula /\[\s*\zssource\ze\s*(/
syntax match agentspeakconfInclude /#include\s*\(<[^>]*>\|"[^"]*"\)/
syntax match agentspeakconfComment +//.*$+ contains=@Spell
syntax region agentspeakconfComment start=+/\*+ end=+\*/+ contains=@Spell

highlight default link agentspeakconfName Function
highlight default link agentspeakconfTrigger Structure
highlight default link agentspeakconfNumber Number
highlight default link agentspeakconfType Type
highlight default link agentspeakconfSection Keyword
highlight default link agentspeakconfSetting Identifier
highlight default link agentspeakconfFormula Statement
highlight default link agentspeakconfInclude Include
highlight default link agentspeakconfComment Comment

let b:current_syntax = 'agentspeakconf'
